-- A unit under two names would be given to two holders.
INSERT INTO board (name, kind, target, product, serial, station, fence)
SELECT $1, $2, $3, $4, $5, $6, 0
WHERE $5 = '' OR NOT EXISTS (SELECT 1 FROM board AS other WHERE other.product = $4 AND other.serial = $5 AND other.name <> $1)
ON CONFLICT (name) DO UPDATE SET
  kind = excluded.kind, target = excluded.target, product = excluded.product, serial = excluded.serial, station = excluded.station,
  holder = NULL, until_ms = NULL
WHERE {free};
