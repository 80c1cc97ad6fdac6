UPDATE outbox SET next_ms = 0 WHERE sink = $1 AND done_ms IS NULL AND dead_ms IS NULL;
