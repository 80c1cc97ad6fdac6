-- A job whose unit must not be judged waits for a person.
UPDATE job SET state = 'dead', holder = NULL, until_ms = NULL, said = $1
WHERE id = $2 AND fence = $3 AND state = 'claimed';
