-- Two stations that did not know of each other may have bound what does not belong together; the first to arrive is kept.
INSERT INTO binding (id, device, unit_id, from_ms, by_operator, reason) VALUES ($1, $2, $3, $4, $5, $6)
ON CONFLICT DO NOTHING;
