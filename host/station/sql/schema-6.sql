-- What a station takes for one, a device and a unit, while the plant knows another unit of the device or another device of the
-- unit, which another station bound.
CREATE TABLE mismatch (
  station TEXT NOT NULL,
  device TEXT NOT NULL CHECK (length(device) = 16),
  unit_id TEXT NOT NULL REFERENCES unit (id),
  -- The last run in which the station judged the one as the other, and when it began.
  run_id TEXT NOT NULL REFERENCES run (id),
  last_ms {int} NOT NULL,
  PRIMARY KEY (station, device, unit_id)
){strict};

-- The devices of a unit and the units of a device, those of earlier days included.
CREATE INDEX binding_unit ON binding (unit_id, from_ms DESC, id DESC);
CREATE INDEX binding_device ON binding (device);
CREATE INDEX audit_rebind ON audit (subject, at_ms) WHERE act = 'rebind';
