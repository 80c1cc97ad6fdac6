-- The last judgement of this unit under plans of this name.
SELECT run.id FROM run
JOIN plan ON plan.sha256 = run.plan_sha256
WHERE run.unit_id = $1 AND plan.name = $2 AND plan.product = $3 AND run.nth > 0 AND run.verdict <> 'ERROR'
ORDER BY run.nth DESC
LIMIT 1;
