-- What the last claim judged ends the job, even if its lease has run out since, or a person has had the job tried again, or the plant
-- was put back and has forgotten the claim.
UPDATE job SET state = 'done', run_id = $1, holder = NULL, until_ms = NULL, said = NULL, fence = $2
WHERE id = $3 AND fence <= $2 AND state <> 'done';
