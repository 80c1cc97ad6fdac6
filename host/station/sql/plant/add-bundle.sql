INSERT INTO bundle (sha256, text) VALUES ($1, $2) ON CONFLICT (sha256) DO UPDATE SET text = excluded.text;
