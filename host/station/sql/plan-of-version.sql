-- The newest other plan of a product, a name and a version by which a run was judged.
SELECT sha256 FROM plan
WHERE product = $1 AND name = $2 AND version = $3 AND sha256 <> $4
  AND EXISTS (SELECT 1 FROM run WHERE run.plan_sha256 = plan.sha256 AND run.verdict IN ('PASS', 'FAIL'))
ORDER BY first_used_ms DESC
LIMIT 1;
