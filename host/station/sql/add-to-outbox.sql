INSERT INTO outbox (sink, kind, subject, attempts, next_ms) VALUES ($1, $2, $3, 0, 0)
ON CONFLICT (sink, kind, subject) DO NOTHING;
