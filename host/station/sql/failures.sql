-- Failures of one kind, in the order of units, and of a unit in the order of runs.
SELECT unit_id, run_id, name
FROM failure
WHERE kind = $1 AND started_ms >= $2 AND started_ms < $3 {filters}
ORDER BY unit_id, run_id;
