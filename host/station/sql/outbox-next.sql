-- When the first entry is due that is tried again by itself.
SELECT min(next_ms) FROM outbox WHERE sink = $1 AND done_ms IS NULL AND dead_ms IS NULL;
