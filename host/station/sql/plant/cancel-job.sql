-- With a higher fence, what an earlier claim judged does not count any more.
UPDATE job SET state = 'dead', said = $1, holder = NULL, until_ms = NULL, fence = fence + 1
WHERE id = $2 AND state IN ('waiting', 'claimed');
