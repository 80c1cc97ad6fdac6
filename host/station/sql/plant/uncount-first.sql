-- Uncounts what was counted as the unit's first judgement, and is its second one now.
UPDATE day_count SET
  units = day_count.units - 1,
  passed = day_count.passed - CASE WHEN earliest.verdict = 'PASS' THEN 1 ELSE 0 END
FROM run AS earliest
JOIN plan ON plan.sha256 = earliest.plan_sha256
WHERE earliest.unit_id = $1 AND earliest.id > $2 AND earliest.nth = 1 AND earliest.verdict <> 'ERROR'
  AND plan.name = $3 AND plan.product = $4
  AND day_count.plan_sha256 = earliest.plan_sha256 AND day_count.station = earliest.station
  AND day_count.lane = earliest.lane AND day_count.day = earliest.started_ms / 86400000;
