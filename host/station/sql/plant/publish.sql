INSERT INTO publication (product, name, number, version, sha256, statement, signature, at_ms)
VALUES ($1, $2, $3, $4, $5, $6, $7, $8)
ON CONFLICT (product, name, number) DO NOTHING;
