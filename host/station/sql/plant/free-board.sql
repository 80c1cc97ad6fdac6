-- A board of this kind that nobody has, at the place behind those that wait longer.
SELECT name FROM board
WHERE kind = $1 AND station IN ('', $2) AND out IS NULL
  AND (holder IS NULL OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT))
ORDER BY name
LIMIT 1 OFFSET $3
FOR UPDATE SKIP LOCKED;
