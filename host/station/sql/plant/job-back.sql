-- A run that judged nothing gives its job back. After five claims the job is dead.
UPDATE job SET state = CASE WHEN attempts >= 5 THEN 'dead' ELSE 'waiting' END, holder = NULL, until_ms = NULL, said = $1
WHERE id = $2 AND fence = $3 AND state = 'claimed';
