-- Jobs that were claimed five times, and never came back.
UPDATE job SET state = 'dead', said = {exhausted}
WHERE {is_exhausted};
