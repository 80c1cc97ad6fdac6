-- Failed runs by the part that is suspected first.
SELECT coalesce(suspect.part, ''), count(*), count(DISTINCT run.unit_id)
FROM run
LEFT JOIN suspect ON suspect.run_id = run.id AND suspect.rank = 1
WHERE run.verdict = 'FAIL' AND +run.started_ms >= $1 AND +run.started_ms < $2 {filters}
GROUP BY coalesce(suspect.part, '');
