SELECT run_id FROM job WHERE id = $1;
