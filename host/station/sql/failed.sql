SELECT count(*), count(DISTINCT run.unit_id)
FROM run WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters};
