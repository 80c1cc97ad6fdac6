-- Notes when a station was at work, by the plant's clock, and returns that time. When another station has its name, nothing is
-- changed or returned.
INSERT INTO station (name, origin, program, plans, unsent, dead, seen_ms)
VALUES ($1, $2, $3, $4, $5, $6, {now_ms})
ON CONFLICT (name) DO UPDATE SET
  program = excluded.program, plans = excluded.plans, unsent = excluded.unsent, dead = excluded.dead, seen_ms = excluded.seen_ms
WHERE station.origin = excluded.origin
RETURNING seen_ms;
