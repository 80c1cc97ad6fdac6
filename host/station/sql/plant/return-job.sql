-- A job that was claimed and not begun is as it was.
UPDATE job SET state = 'waiting', holder = NULL, until_ms = NULL, attempts = attempts - 1
WHERE id = $1 AND holder = $2 AND fence = $3 AND state = 'claimed';
