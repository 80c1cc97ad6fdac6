UPDATE outbox SET dead_ms = NULL, next_ms = 0 WHERE sink = $1 AND done_ms IS NULL AND dead_ms IS NOT NULL;
