-- For each sink: how many entries are unsent, how many of them are not lines of the audit, how many wait for a person, the first
-- of them, and what the sink said last to one that will be tried again. The last try of an entry lies before its next one by 7/8
-- of the longest wait after that many tries, give or take an eighth.
SELECT sink, count(*), count(CASE WHEN kind <> 'audit' THEN 1 END), count(dead_ms), min(subject), (
  SELECT tried.said
  FROM outbox AS tried
  WHERE tried.sink = outbox.sink AND tried.done_ms IS NULL AND tried.dead_ms IS NULL AND tried.said IS NOT NULL
  ORDER BY tried.next_ms - CASE
      WHEN tried.attempts > 20 OR $1 * (1 << CAST(tried.attempts - 1 AS integer)) > $2 THEN $2
      ELSE $1 * (1 << CAST(tried.attempts - 1 AS integer))
    END * 7 / 8 DESC
  LIMIT 1
)
FROM outbox
WHERE done_ms IS NULL
GROUP BY sink
ORDER BY sink;
