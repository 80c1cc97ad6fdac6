INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ($1, $2, $3, $4)
ON CONFLICT (product, serial) DO NOTHING;
