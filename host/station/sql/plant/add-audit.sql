INSERT INTO audit (id, at_ms, operator_id, act, subject, detail) VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT (id) DO NOTHING;
