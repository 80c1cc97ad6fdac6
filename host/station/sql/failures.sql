-- Failures of one kind, unit after unit, and of a unit run after run.
SELECT unit_id, run_id, name
FROM failure
WHERE kind = $1 AND started_ms >= $2 AND started_ms < $3 {filters}
ORDER BY unit_id, run_id;
