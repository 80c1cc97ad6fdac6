-- Notes when a station was at work, by the plant's clock, and returns that time. When another station has its name, nothing is
-- changed or returned: one with another folder, or one with a copy of the folder, of which the plant has heard since the program
-- that asks told it last, and lately. A program that has told nothing yet may be the station's next start.
INSERT INTO station (name, origin, program, plans, unsent, dead, seen_ms)
VALUES ($1, $2, $3, $4, $5, $6, {now_ms})
ON CONFLICT (name) DO UPDATE SET
  program = excluded.program, plans = excluded.plans, unsent = excluded.unsent, dead = excluded.dead, seen_ms = excluded.seen_ms
WHERE station.origin = excluded.origin AND station.seen_ms <= greatest($7, {now_ms} - $8)
RETURNING seen_ms;
