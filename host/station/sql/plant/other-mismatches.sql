-- Mismatches that contradict their run.
SELECT mismatch.run_id FROM mismatch
JOIN run ON run.id = mismatch.run_id
WHERE run.station <> mismatch.station OR run.unit_id <> mismatch.unit_id OR run.started_ms <> mismatch.last_ms
  OR run.device IS NULL OR run.device <> mismatch.device
ORDER BY mismatch.run_id;
