-- When the first run ended that this sink does not have.
SELECT min(run.ended_ms) FROM outbox
JOIN run ON run.id = outbox.subject
WHERE outbox.sink = $1 AND outbox.done_ms IS NULL AND outbox.kind = $2;
