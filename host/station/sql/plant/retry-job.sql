UPDATE job SET state = 'waiting', attempts = 0 WHERE id = $1 AND {job_state} IN ('dead', 'cancelled');
