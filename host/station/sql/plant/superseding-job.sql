-- The job, if another run has ended it, or it was claimed or cancelled after this claim: fences only grow, and one that is lower than
-- the claim's is that of a plant which was put back.
SELECT id FROM job WHERE id = $1 AND (fence > $2 OR (state = 'done' AND run_id IS DISTINCT FROM $3));
