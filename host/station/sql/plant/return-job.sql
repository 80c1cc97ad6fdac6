-- A job that was claimed and not begun is as it was, but for what is to be said of it.
UPDATE job SET state = 'waiting', holder = NULL, until_ms = NULL, attempts = attempts - 1, said = coalesce($1, said)
WHERE id = $2 AND holder = $3 AND fence = $4 AND state = 'claimed';
