-- Devices and units that belong together for a station and not for the plant, each with the binding that contradicts this. It is
-- settled if a person has bound one of the two anew since.
SELECT mismatch.station, mismatch.device, unit.product, unit.serial, mismatch.run_id, mismatch.last_ms,
  binding.device, other.product, other.serial, binding.from_ms, coalesce(run.station, '')
FROM mismatch
JOIN unit ON unit.id = mismatch.unit_id
JOIN binding ON binding.to_ms IS NULL AND (binding.device = mismatch.device OR binding.unit_id = mismatch.unit_id)
JOIN unit AS other ON other.id = binding.unit_id
LEFT JOIN run ON run.id = binding.id
WHERE (binding.device <> mismatch.device OR binding.unit_id <> mismatch.unit_id)
  AND NOT EXISTS (
    SELECT 1 FROM audit
    WHERE audit.act = 'rebind' AND audit.subject = mismatch.unit_id AND audit.at_ms > mismatch.last_ms
  )
  AND NOT EXISTS (
    SELECT 1 FROM binding AS later
    WHERE later.device = mismatch.device AND later.from_ms > mismatch.last_ms
      AND NOT EXISTS (SELECT 1 FROM run AS judged WHERE judged.id = later.id)
  )
ORDER BY mismatch.last_ms DESC, mismatch.run_id, other.serial;
