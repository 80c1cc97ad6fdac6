INSERT INTO job (id, plan_sha256, product, serial, kind, needs, priority, state, fence, attempts, created_ms, operator_id)
VALUES ($1, $2, $3, $4, $5, $6, $7, 'waiting', 0, 0, CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT), $8);
