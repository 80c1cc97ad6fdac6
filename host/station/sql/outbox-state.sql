-- How much is still to be sent to each sink, how much of it waits for a person, and what came about first of it.
SELECT sink, count(*), count(dead_ms), min(subject), max(CASE WHEN dead_ms IS NULL THEN said END)
FROM outbox
WHERE done_ms IS NULL
GROUP BY sink
ORDER BY sink;
