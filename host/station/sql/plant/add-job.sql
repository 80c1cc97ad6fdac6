INSERT INTO job (id, plan_sha256, product, serial, kind, needs, priority, state, fence, attempts, created_ms, operator_id)
VALUES ($1, $2, $3, $4, $5, $6, $7, 'waiting', 0, 0, {now_ms}, $8);
