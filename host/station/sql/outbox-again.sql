-- Nothing counts as sent to the sink any more.
UPDATE outbox SET done_ms = NULL, attempts = 0, next_ms = 0 WHERE sink = $1 AND done_ms IS NOT NULL;
