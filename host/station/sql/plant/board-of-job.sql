-- A free board that is this unit, or of this kind, and that nobody waits for.
SELECT name FROM board
WHERE product = $1 AND station IN ('', $2) AND out IS NULL
  AND (serial = $3 OR ($3 = '' AND kind = $4 AND serial <> ''))
  AND (holder IS NULL OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT))
  AND NOT EXISTS (
    SELECT 1 FROM waiter
    WHERE waiter.kind = board.kind AND waiter.until_ms >= CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)
      AND board.station IN ('', substring(waiter.holder FROM '^(.*) '))
  )
ORDER BY station = '', name
LIMIT 1
FOR UPDATE SKIP LOCKED;
