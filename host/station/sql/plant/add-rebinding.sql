-- What a person bound, until the device or the unit was bound anew; that may have arrived before this.
INSERT INTO binding (id, device, unit_id, from_ms, to_ms, by_operator, reason)
SELECT $1, $2, $3, CAST($4 AS BIGINT), min(later.ms), $5, $6 FROM (
  SELECT from_ms AS ms FROM binding WHERE id > $1 AND (device = $2 OR unit_id = $3)
  UNION ALL
  SELECT at_ms FROM audit WHERE act = 'rebind' AND subject = $3 AND id > $1
) AS later;
