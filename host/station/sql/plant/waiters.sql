SELECT kind, holder, id FROM waiter
WHERE until_ms >= CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)
ORDER BY kind, id;
