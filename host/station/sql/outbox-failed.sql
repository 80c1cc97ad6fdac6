UPDATE outbox SET attempts = attempts + 1, next_ms = $1, dead_ms = $2, said = $3
WHERE sink = $4 AND kind = $5 AND subject = $6 AND done_ms IS NULL;
