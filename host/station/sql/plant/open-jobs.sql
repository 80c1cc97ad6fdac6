-- How many jobs are waiting and how many are claimed, and how long ago the oldest of each was added. The index job_open has them all.
SELECT {job_state}, count(*), {now_ms} - min(job.created_ms)
FROM job
WHERE job.state IN ('waiting', 'claimed') AND NOT {is_exhausted}
GROUP BY 1;
