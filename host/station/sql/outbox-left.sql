-- What is unsent at a sink: how many entries, how many of them are not lines of the audit, how many wait for a person, and how many
-- of the others were tried in vain.
SELECT count(*), count(CASE WHEN kind <> 'audit' THEN 1 END), count(dead_ms), count(CASE WHEN dead_ms IS NULL THEN said END)
FROM outbox
WHERE sink = $1 AND done_ms IS NULL;
