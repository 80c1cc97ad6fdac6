SELECT count(*) FROM waiter
WHERE kind = $1 AND id < $2 AND until_ms >= CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT);
