-- A page of runs, the newest first; {filters} are the conditions of the filters that are set.
SELECT run.id, run.started_ms, run.ended_ms, unit.product, unit.serial, plan.name, plan.version, run.station, run.lane,
  run.operator_id, run.verdict, run.cause, run.headline, run.nth,
  EXISTS (SELECT 1 FROM waiver WHERE waiver.run_id = run.id), run.record_sha256,
  run.board_kind, run.exit_code
FROM run
-- A left join keeps the engines from beginning with a table other than the runs.
LEFT JOIN unit ON unit.id = run.unit_id
LEFT JOIN plan ON plan.sha256 = run.plan_sha256
{filters}
ORDER BY run.started_ms DESC, run.id DESC
LIMIT {limit};
