-- What was bound to a device, or to a unit, until a person bound anew after a run had begun. A binding ends at the time of the change
-- that ends it.
SELECT unit.product, unit.serial, binding.device FROM binding
JOIN unit ON unit.id = binding.unit_id
JOIN audit ON audit.act = 'rebind' AND audit.at_ms = binding.to_ms
WHERE audit.id > $1 AND (binding.device = $2 OR binding.unit_id = $3)
ORDER BY audit.id DESC, binding.id DESC LIMIT 1;
