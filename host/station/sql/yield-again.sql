-- Every judgement of a unit that is not its first, in their order, beside the unit's first ones, each under its plan's name.
SELECT again.id, again.verdict, again.started_ms, again.plan_sha256, again.unit_id,
  first.id, first.verdict, first.started_ms, first.plan_sha256, first.station, first.lane
FROM run AS again
JOIN run AS first ON first.unit_id = again.unit_id AND first.nth = 1 AND first.verdict <> 'ERROR'
WHERE again.nth >= 2 AND again.verdict <> 'ERROR'
ORDER BY again.unit_id, again.nth;
