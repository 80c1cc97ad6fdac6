-- What a FAIL failed by: the part that is suspected first, and every failed check, which is a limit that blames the board, or
-- a step that failed by more than its limits.
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms)
SELECT run.id, 'part', coalesce(suspect.part, ''), run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
LEFT JOIN suspect ON suspect.run_id = run.id AND suspect.rank = 1
WHERE run.id = $1 AND run.verdict = 'FAIL' AND run.nth > 0
UNION
SELECT run.id, 'check', measurement.name, run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
JOIN measurement ON measurement.run_id = run.id AND measurement.outcome = 'failed' AND measurement.blames = 'board'
WHERE run.id = $1 AND run.verdict = 'FAIL' AND run.nth > 0
UNION
SELECT run.id, 'check', step.name, run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
JOIN step ON step.run_id = run.id AND step.outcome = 'failed'
WHERE run.id = $1 AND run.verdict = 'FAIL' AND run.nth > 0 AND (
  NOT EXISTS (
    SELECT 1 FROM measurement
    WHERE measurement.run_id = step.run_id AND measurement.seq = step.seq
      AND measurement.outcome = 'failed' AND measurement.blames = 'board'
  )
  OR EXISTS (
    SELECT 1 FROM measurement
    WHERE measurement.run_id = step.run_id AND measurement.seq = step.seq AND measurement.attempt = step.attempt
      AND measurement.name = 'frames.samples_differing' AND measurement.value > 0
  )
);
