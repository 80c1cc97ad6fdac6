-- The job, if it is done, or was claimed or cancelled after this claim: fences only grow, and one that is lower than the claim's is
-- that of a plant which was put back.
SELECT id FROM job WHERE id = $1 AND (state = 'done' OR fence > $2);
