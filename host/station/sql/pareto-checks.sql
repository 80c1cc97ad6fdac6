-- Failed runs by what failed: a limit that blames the board, or a step beside its limits.
SELECT failed.name, count(DISTINCT run.id), count(DISTINCT run.unit_id)
FROM run
JOIN (
  SELECT run_id, name FROM measurement WHERE outcome = 'failed' AND blames = 'board'
  UNION ALL
  SELECT step.run_id, step.name FROM step WHERE step.outcome = 'failed' AND NOT EXISTS (
    SELECT 1 FROM measurement
    WHERE measurement.run_id = step.run_id AND measurement.seq = step.seq
      AND measurement.outcome = 'failed' AND measurement.blames = 'board'
  )
) AS failed ON failed.run_id = run.id
WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters}
GROUP BY failed.name;
