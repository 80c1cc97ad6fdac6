INSERT INTO waiver (id, run_id, at_ms, operator_id, reason) VALUES ($1, $2, $3, $4, $5) ON CONFLICT (id) DO NOTHING;
