-- The newest of this kind that the sink certainly has. Ids are in the order in which what they name came about.
SELECT subject FROM outbox WHERE sink = $1 AND kind = $2 AND done_ms IS NOT NULL ORDER BY subject DESC LIMIT 1;
