-- What stations call a plan, where runs were judged by several plans that they call the same. A job brings its plan before it has a
-- run.
SELECT product || ' ' || name || ' ' || version
FROM plan
WHERE EXISTS (SELECT 1 FROM run WHERE run.plan_sha256 = plan.sha256 AND run.verdict IN ('PASS', 'FAIL'))
GROUP BY product, name, version
HAVING count(*) > 1;
