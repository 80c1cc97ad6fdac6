-- This run's device and unit, if they were not bound to each other during the run and one of them is bound to another now.
INSERT INTO mismatch (station, device, unit_id, run_id, last_ms)
SELECT run.station, run.device, run.unit_id, run.id, run.started_ms
FROM run
WHERE run.id = $1
  AND NOT EXISTS (
    SELECT 1 FROM binding
    WHERE binding.unit_id = run.unit_id AND binding.device = run.device
      AND binding.from_ms <= run.ended_ms AND (binding.to_ms IS NULL OR binding.to_ms >= run.started_ms)
  )
  AND (
    EXISTS (
      SELECT 1 FROM binding
      WHERE binding.to_ms IS NULL AND binding.device = run.device AND binding.unit_id <> run.unit_id
    )
    OR EXISTS (
      SELECT 1 FROM binding
      WHERE binding.to_ms IS NULL AND binding.unit_id = run.unit_id AND binding.device <> run.device
    )
  )
ON CONFLICT (station, device, unit_id) DO UPDATE SET run_id = excluded.run_id, last_ms = excluded.last_ms
WHERE excluded.last_ms > mismatch.last_ms;
