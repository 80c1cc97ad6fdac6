-- The order is that of the ids, but not that of their index, in which all runs that ever were stand.
SELECT run.id, run.station, run.lane, run.unit_id, unit.product, unit.serial, run.plan_sha256, run.variant,
  run.operator_id, run.target, run.fence, run.started_ms, plan.name, plan.version, plan.text
FROM run
JOIN unit ON unit.id = run.unit_id
JOIN plan ON plan.sha256 = run.plan_sha256
WHERE run.state = 'open' ORDER BY run.id || '';
