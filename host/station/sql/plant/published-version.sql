SELECT statement, signature FROM publication
WHERE product = $1 AND name = $2 AND version = $3
ORDER BY number DESC
LIMIT 1;
