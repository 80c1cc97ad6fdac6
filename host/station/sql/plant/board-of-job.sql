-- A free board that is this unit, or of this kind, and that nobody waits for.
SELECT name FROM board
WHERE product = $1 AND station IN ('', $2) AND out IS NULL
  AND (serial = $3 OR ($3 = '' AND kind = $4 AND serial <> ''))
  AND {free}
  AND NOT {waited_for}
ORDER BY station = '', name
LIMIT 1
FOR UPDATE SKIP LOCKED;
