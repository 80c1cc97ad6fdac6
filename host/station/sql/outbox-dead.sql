-- The first entries that a sink has refused, and that wait for a person.
SELECT sink, kind, subject, attempts, dead_ms, said FROM outbox
WHERE sink = $1 AND done_ms IS NULL AND dead_ms IS NOT NULL
ORDER BY subject
LIMIT $2;
