-- Enters for this sink all that was kept before and has no entry for it.
INSERT INTO outbox (sink, kind, subject, attempts, next_ms)
SELECT $1, kind, subject, 0, 0 FROM ({of}) AS unentered;
