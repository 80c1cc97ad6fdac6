-- Plans that jobs brought; they need not have a run.
SELECT plan.sha256, plan.name, plan.version, plan.text, plan.product, plan.first_used_ms
FROM plan
WHERE EXISTS (SELECT 1 FROM job WHERE job.plan_sha256 = plan.sha256)
ORDER BY plan.sha256;
