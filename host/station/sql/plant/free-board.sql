-- A board of this kind that nobody has, after those that are left to others. Boards that only this station reaches come first.
SELECT name FROM board
WHERE kind = $1 AND station IN ('', $2) AND out IS NULL
  AND {free}
ORDER BY station = '', name
LIMIT 1 OFFSET $3
FOR UPDATE SKIP LOCKED;
