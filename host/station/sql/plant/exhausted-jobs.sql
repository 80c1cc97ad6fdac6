-- Jobs that were claimed five times, and never came back.
UPDATE job SET state = 'dead', said = 'it was claimed five times, and no run of it was judged'
WHERE state = 'claimed' AND attempts >= 5 AND until_ms < {now_ms};
