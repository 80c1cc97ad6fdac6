-- Whether later runs of this unit under plans of this name were counted already.
SELECT count(*) FROM run
JOIN plan ON plan.sha256 = run.plan_sha256
WHERE run.unit_id = $1 AND run.id > $2 AND run.nth > 0 AND plan.name = $3 AND plan.product = $4;
