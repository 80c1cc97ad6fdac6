SELECT run.id, run.started_ms, run.ended_ms, unit.product, unit.serial, plan.name, plan.version, run.station, run.lane,
  run.operator_id, run.verdict, run.cause, run.headline, run.nth,
  EXISTS (SELECT 1 FROM waiver WHERE waiver.run_id = run.id), run.record_sha256,
  run.board_kind, run.exit_code, run.variant, run.target, run.device, run.build
FROM run
JOIN unit ON unit.id = run.unit_id
JOIN plan ON plan.sha256 = run.plan_sha256
WHERE {of} = $1
ORDER BY run.id DESC;
