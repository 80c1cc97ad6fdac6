INSERT INTO waiter (id, kind, holder, until_ms)
VALUES ($1, $2, $3, {now_ms} + $4)
ON CONFLICT (id) DO UPDATE SET until_ms = excluded.until_ms;
