-- Failed runs, and units of them, by what failed: a limit that blames the board, or a step by more than its limits.
SELECT name, count(DISTINCT run_id), count(DISTINCT unit_id)
FROM (
  SELECT run.id AS run_id, run.unit_id, measurement.name
  FROM run
  JOIN measurement ON measurement.run_id = run.id AND measurement.outcome = 'failed' AND measurement.blames = 'board'
  WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters}
  UNION ALL
  SELECT run.id AS run_id, run.unit_id, step.name
  FROM run
  JOIN step ON step.run_id = run.id AND step.outcome = 'failed'
  WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters} AND (
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
  )
) AS failed
GROUP BY name;
