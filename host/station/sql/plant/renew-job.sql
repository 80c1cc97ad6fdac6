UPDATE job SET until_ms = {now_ms} + $1
WHERE id = $2 AND holder = $3 AND fence = $4 AND state = 'claimed';
