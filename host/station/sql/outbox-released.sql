UPDATE outbox SET dead_ms = NULL, next_ms = 0
WHERE subject = $1 AND ($2 = '' OR sink = $2) AND done_ms IS NULL AND dead_ms IS NOT NULL;
