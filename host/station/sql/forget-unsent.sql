DELETE FROM outbox WHERE sink = $1 AND done_ms IS NULL;
