-- How many jobs are in each state. Every job is read for that.
SELECT {job_state}, count(*) FROM job
GROUP BY 1;
