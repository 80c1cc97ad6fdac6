-- Failed runs, and units of them, by the part that is suspected first.
SELECT part, CAST(sum(runs) AS BIGINT), count(*)
FROM (
  SELECT run.unit_id, coalesce(suspect.part, '') AS part, count(*) AS runs
  FROM run
  LEFT JOIN suspect ON suspect.run_id = run.id AND suspect.rank = 1
  WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters}
  GROUP BY run.unit_id, coalesce(suspect.part, '')
) AS of_unit
GROUP BY part;
