-- How many jobs wait for a person. Every job is read for that: no index has those that are dead.
SELECT count(*) FROM job
WHERE {job_state} = 'dead';
