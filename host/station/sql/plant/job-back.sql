-- A run that judged nothing gives its job back. After five claims the job is dead. A plant that was put back and has forgotten the
-- claim gives the next one a higher fence, unless somebody has the job by now.
UPDATE job SET state = CASE WHEN {is_spent} THEN 'dead' ELSE 'waiting' END, holder = NULL, until_ms = NULL, said = $1, fence = $2
WHERE id = $3 AND (
  (fence = $2 AND state = 'claimed')
  OR (fence < $2 AND (state = 'waiting' OR {is_lapsed}))
);
