-- A free board that is this unit, or of this kind.
SELECT name FROM board
WHERE product = $1 AND station IN ('', $2) AND out IS NULL
  AND (serial = $3 OR ($3 = '' AND kind = $4 AND serial <> ''))
  AND (holder IS NULL OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT))
ORDER BY name
LIMIT 1
FOR UPDATE SKIP LOCKED;
