-- How much is still to be sent to each sink, how much of it is no line of the audit, how much waits for a person, what came about
-- first of it, and what was said last to one that is tried again. A try lies before the next one by 7/8 of the wait behind so many tries, and an eighth
-- more or less.
SELECT sink, count(*), count(CASE WHEN kind <> 'audit' THEN 1 END), count(dead_ms), min(subject), (
  SELECT tried.said
  FROM outbox AS tried
  WHERE tried.sink = outbox.sink AND tried.done_ms IS NULL AND tried.dead_ms IS NULL AND tried.said IS NOT NULL
  ORDER BY tried.next_ms
    - CASE WHEN tried.attempts > 9 THEN 262500 ELSE 875 * (1 << CAST(tried.attempts - 1 AS integer)) END DESC
  LIMIT 1
)
FROM outbox
WHERE done_ms IS NULL
GROUP BY sink
ORDER BY sink;
