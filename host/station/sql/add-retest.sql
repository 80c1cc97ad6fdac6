-- Enters this judgement, if it is not the unit's first, together with the first one under plans of the same name.
INSERT INTO retest (unit_id, plan, judgements, first_run, first_plan_sha256, station, lane, first_ms, first_verdict,
  last_run, last_ms, last_verdict)
SELECT again.unit_id, theirs.name, again.nth, earliest.id, earliest.plan_sha256, earliest.station, earliest.lane,
  earliest.started_ms, earliest.verdict, again.id, again.started_ms, again.verdict
FROM run AS again
JOIN plan AS theirs ON theirs.sha256 = again.plan_sha256
JOIN run AS earliest ON earliest.unit_id = again.unit_id AND earliest.nth = 1 AND earliest.verdict <> 'ERROR'
JOIN plan AS ours ON ours.sha256 = earliest.plan_sha256 AND ours.name = theirs.name AND ours.product = theirs.product
WHERE again.id = $1 AND again.nth >= 2 AND again.verdict <> 'ERROR'
ON CONFLICT (unit_id, plan) DO UPDATE SET
  judgements = excluded.judgements,
  last_run = excluded.last_run,
  last_ms = excluded.last_ms,
  last_verdict = excluded.last_verdict;
