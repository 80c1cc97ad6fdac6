-- The newest of this kind that the sink has for certain. Their ids have the order in which they came about.
SELECT subject FROM outbox WHERE sink = $1 AND kind = $2 AND done_ms IS NOT NULL ORDER BY subject DESC LIMIT 1;
