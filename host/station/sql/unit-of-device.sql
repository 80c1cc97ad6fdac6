SELECT unit.product, unit.serial FROM binding
JOIN unit ON unit.id = binding.unit_id
WHERE binding.device = $1 AND binding.to_ms IS NULL;
