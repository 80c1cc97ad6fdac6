-- The job, if it is done, or was claimed or cancelled after this claim.
SELECT id FROM job WHERE id = $1 AND (state = 'done' OR fence <> $2);
