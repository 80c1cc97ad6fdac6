-- How many jobs are in each state but done, and how long ago the oldest of them was added.
SELECT {job_state}, count(*), {now_ms} - min(job.created_ms)
FROM job
WHERE job.state <> 'done'
GROUP BY 1;
