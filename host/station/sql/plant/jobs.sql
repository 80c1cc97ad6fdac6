-- The jobs in some states, the newest first, following this one.
SELECT job.id, plan.name, plan.version, job.product, job.serial, job.kind, job.needs, job.priority, {job_state},
  job.holder, job.attempts, job.run_id, run.verdict, job.created_ms, job.operator_id,
  CASE WHEN {is_exhausted} THEN {exhausted} ELSE job.said END
FROM job
JOIN plan ON plan.sha256 = job.plan_sha256
LEFT JOIN run ON run.id = job.run_id
WHERE {job_state} = ANY (string_to_array($1, ' ')) AND ($2 = '' OR job.id < $2)
ORDER BY job.id DESC
LIMIT $3;
