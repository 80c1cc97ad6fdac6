INSERT INTO binding (id, device, unit_id, from_ms, by_operator, reason) VALUES ($1, $2, $3, $4, $5, $6);
