INSERT INTO plan (sha256, name, version, product, text, first_used_ms) VALUES ($1, $2, $3, $4, $5, $6)
ON CONFLICT (sha256) DO NOTHING;
