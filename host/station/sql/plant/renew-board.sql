UPDATE board SET until_ms = {now_ms} + $1
WHERE name = $2 AND holder = $3 AND fence = $4 AND out IS NULL;
