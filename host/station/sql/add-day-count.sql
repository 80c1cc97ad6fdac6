INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed)
SELECT plan_sha256, station, lane, started_ms / 86400000, 1,
  CASE WHEN verdict = 'ERROR' THEN 1 ELSE 0 END,
  CASE WHEN cause = 'crash' THEN 1 ELSE 0 END,
  CASE WHEN verdict <> 'ERROR' AND nth = 1 THEN 1 ELSE 0 END,
  CASE WHEN verdict = 'PASS' AND nth = 1 THEN 1 ELSE 0 END
FROM run WHERE id = $1 AND nth > 0
ON CONFLICT (plan_sha256, station, lane, day) DO UPDATE SET
  runs = day_count.runs + excluded.runs,
  errors = day_count.errors + excluded.errors,
  crashes = day_count.crashes + excluded.crashes,
  units = day_count.units + excluded.units,
  passed = day_count.passed + excluded.passed;
