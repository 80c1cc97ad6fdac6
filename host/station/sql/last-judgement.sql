-- By the unit, which has few runs, and not by the lane, which has many.
SELECT run.id, run.verdict, run.started_ms, run.target FROM run
JOIN unit ON unit.id = run.unit_id
WHERE run.station || '' = $1 AND run.lane = $2 AND run.plan_sha256 = $3 AND unit.product = $4 AND unit.serial = $5
  AND run.verdict IN ('PASS', 'FAIL')
ORDER BY run.id DESC LIMIT 1;
