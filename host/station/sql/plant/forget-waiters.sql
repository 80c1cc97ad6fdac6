DELETE FROM waiter WHERE id = $1 OR until_ms < CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT);
