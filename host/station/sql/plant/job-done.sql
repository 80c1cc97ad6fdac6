-- What the last claim judged ends the job, even if its lease has run out since, or a person has had the job tried again.
UPDATE job SET state = 'done', run_id = $1, holder = NULL, until_ms = NULL, said = NULL
WHERE id = $2 AND fence = $3 AND state <> 'done';
