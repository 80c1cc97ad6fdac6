-- The first job that a station with these plans and these things can judge now, on a board that is free and that nobody waits for.
WITH free AS MATERIALIZED (
  SELECT product, kind, serial FROM board
  WHERE serial <> '' AND station IN ('', $1) AND out IS NULL
    AND (holder IS NULL OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT))
    AND NOT EXISTS (
      SELECT 1 FROM waiter
      WHERE waiter.kind = board.kind AND waiter.until_ms >= CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)
        AND board.station IN ('', substring(waiter.holder FROM '^(.*) '))
    )
)
SELECT id, product, serial, kind FROM job
WHERE state IN ('waiting', 'claimed')
  AND (state = 'waiting' OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT))
  AND attempts < 5
  AND plan_sha256 = ANY (string_to_array($2, ' '))
  AND string_to_array(needs, ' ') <@ string_to_array($3, ' ')
  AND (
    (serial <> '' AND (product, serial) IN (SELECT product, serial FROM free))
    OR (serial = '' AND (product, kind) IN (SELECT product, kind FROM free))
  )
ORDER BY priority DESC, id
LIMIT 1
FOR UPDATE SKIP LOCKED;
