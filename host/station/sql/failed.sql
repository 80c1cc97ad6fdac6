SELECT CAST(coalesce(sum(runs), 0) AS BIGINT), count(*)
FROM (
  SELECT count(*) AS runs FROM run
  WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters}
  GROUP BY run.unit_id
) AS of_unit;
