-- A unit that checks shifts is judged in every lane and every shift, so nothing but the index `run_judged` is quick.
SELECT run.id, run.verdict, run.started_ms, run.target FROM run
JOIN unit ON unit.id = run.unit_id
WHERE run.station = $1 AND run.lane = $2 AND run.plan_sha256 = $3 AND unit.product = $4 AND unit.serial = $5
  AND run.verdict IN ('PASS', 'FAIL')
ORDER BY run.id DESC LIMIT 1;
