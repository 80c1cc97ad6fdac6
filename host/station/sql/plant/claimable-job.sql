-- The first job that a station with these plans and this equipment can judge now, on a board that is free and nobody waits for.
WITH free AS MATERIALIZED (
  SELECT product, kind, serial FROM board
  WHERE serial <> '' AND station IN ('', $1) AND out IS NULL
    AND {free}
    AND NOT {waited_for}
)
SELECT id, product, serial, kind FROM job
WHERE state IN ('waiting', 'claimed')
  AND (state = 'waiting' OR until_ms < {now_ms})
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
