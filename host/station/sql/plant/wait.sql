INSERT INTO waiter (id, kind, holder, until_ms)
VALUES ($1, $2, $3, CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT) + $4)
ON CONFLICT (id) DO UPDATE SET until_ms = excluded.until_ms;
