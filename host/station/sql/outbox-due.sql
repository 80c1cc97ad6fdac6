-- What is to be sent now, in the order in which it came about; also what would wait longer than any entry does, because the clock
-- was set back.
SELECT kind, subject, attempts FROM outbox
WHERE sink = $1 AND done_ms IS NULL AND dead_ms IS NULL AND (next_ms <= $2 OR next_ms > $3)
ORDER BY subject
LIMIT 50;
