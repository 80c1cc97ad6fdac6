SELECT run.verdict, run.id, run.ended_ms FROM run
JOIN unit ON unit.id = run.unit_id
WHERE unit.product = $1 AND unit.serial = $2 AND run.plan_sha256 = $3 AND run.nth > 0 AND run.verdict IN ('PASS', 'FAIL')
ORDER BY run.id DESC LIMIT 1;
