SELECT step.run_id, step.seq, step.attempt, step.name, step.outcome, step.started_ms, step.ended_ms, step.detail
FROM run JOIN step ON step.run_id = run.id
WHERE {of} = $1
ORDER BY step.run_id, step.seq, step.attempt;
