-- Every judgement of a unit that is not its first, in their order, beside the unit's first under plans of that name.
SELECT again.id, again.verdict, again.started_ms, again.plan_sha256, again.unit_id, unit.serial,
  first.id, first.verdict, first.started_ms, first.plan_sha256, first.station, first.lane
FROM run AS again
JOIN plan AS theirs ON theirs.sha256 = again.plan_sha256
JOIN unit ON unit.id = again.unit_id
JOIN run AS first ON first.unit_id = again.unit_id AND first.nth = 1 AND first.verdict <> 'ERROR'
JOIN plan AS ours ON ours.sha256 = first.plan_sha256 AND ours.name = theirs.name AND ours.product = theirs.product
WHERE again.nth >= 2 AND again.verdict <> 'ERROR'
ORDER BY again.unit_id, again.nth;
