UPDATE board SET until_ms = CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT) + $1
WHERE name = $2 AND holder = $3 AND fence = $4 AND out IS NULL;
