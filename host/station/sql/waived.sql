-- Waived FAILs, and whether the unit was judged only once under plans of that name. The few waivers choose the runs.
SELECT run.id, run.plan_sha256, run.station, run.lane, run.started_ms, NOT EXISTS (
  SELECT 1 FROM retest
  JOIN plan ON plan.sha256 = run.plan_sha256
  WHERE retest.unit_id = run.unit_id AND retest.plan = plan.name
)
FROM waiver JOIN run ON run.id = waiver.run_id
WHERE coalesce(run.verdict, '') = 'FAIL' AND run.nth > 0;
