-- The last of the next runs before a bound; none when there are no more.
SELECT max(page.id) FROM (SELECT id FROM run WHERE id > $1 AND id < $2 ORDER BY id LIMIT 5000) AS page;
