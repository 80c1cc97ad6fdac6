UPDATE job SET state = 'done', run_id = $1, holder = NULL, until_ms = NULL, said = NULL
WHERE id = $2 AND fence = $3 AND state = 'claimed';
