-- Jobs that are done by a run that does not exist.
SELECT job.id FROM job
LEFT JOIN run ON run.id = job.run_id
WHERE run.id IS NULL AND (job.state = 'done' OR job.run_id IS NOT NULL)
ORDER BY job.id;
