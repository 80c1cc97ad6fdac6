SELECT run.id, run.plan_sha256, run.station, run.lane, run.started_ms
FROM waiver JOIN run ON run.id = waiver.run_id
WHERE run.verdict = 'FAIL';
