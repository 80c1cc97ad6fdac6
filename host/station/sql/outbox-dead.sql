SELECT sink, kind, subject, attempts, dead_ms, said FROM outbox
WHERE done_ms IS NULL AND dead_ms IS NOT NULL
ORDER BY sink, subject;
