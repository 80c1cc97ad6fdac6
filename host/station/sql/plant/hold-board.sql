UPDATE board SET holder = $1, fence = fence + 1, until_ms = CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT) + $2
WHERE name = $3
RETURNING name, target, fence, product, serial;
