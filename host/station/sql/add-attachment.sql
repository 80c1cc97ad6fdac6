INSERT INTO attachment (run_id, name, sha256, bytes, media_type) VALUES ($1, $2, $3, $4, $5);
