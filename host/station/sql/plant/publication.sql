SELECT statement, signature FROM publication
WHERE product = $1 AND name = $2
ORDER BY number DESC
LIMIT 1;
