SELECT waiver.run_id, waiver.at_ms, waiver.operator_id, waiver.reason
FROM run JOIN waiver ON waiver.run_id = run.id
WHERE {of} = $1
ORDER BY waiver.run_id, waiver.id;
