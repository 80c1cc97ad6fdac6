-- A run that judged nothing gives its job back. After five claims the job is dead; a run that says nothing of the job costs no claim:
-- the third value is then 1, and otherwise 0. A plant that was put back and has forgotten the claim gives the next one a higher fence,
-- unless somebody has the job by now.
UPDATE job SET said = $1, fence = $2, holder = NULL, until_ms = NULL,
  state = CASE WHEN {is_spent} AND $3 = 0 THEN 'dead' ELSE 'waiting' END, attempts = greatest(attempts - CASE WHEN fence = $2 THEN $3 ELSE 0 END, 0)
WHERE id = $4 AND (
  (fence = $2 AND state = 'claimed')
  OR (fence < $2 AND (state = 'waiting' OR {is_lapsed}))
);
