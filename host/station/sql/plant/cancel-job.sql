-- With a higher fence, what an earlier claim judged does not count any more. That there are no claims is what tells the job from one
-- that came to nothing.
UPDATE job SET state = 'dead', said = $1, holder = NULL, until_ms = NULL, fence = fence + 1, attempts = 0
WHERE id = $2 AND state <> 'done' AND NOT {is_cancelled};
