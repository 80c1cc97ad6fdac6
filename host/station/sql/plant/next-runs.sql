-- The last of the next runs in front of a bound, none behind them.
SELECT max(page.id) FROM (SELECT id FROM run WHERE id > $1 AND id < $2 ORDER BY id LIMIT 5000) AS page;
