INSERT INTO board (name, kind, target, product, serial, station, fence) VALUES ($1, $2, $3, $4, $5, $6, 0)
ON CONFLICT (name) DO UPDATE SET
  kind = excluded.kind, target = excluded.target, product = excluded.product, serial = excluded.serial, station = excluded.station
WHERE board.holder IS NULL;
