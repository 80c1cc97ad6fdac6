INSERT INTO suspect (run_id, rank, part, place, explained) VALUES ($1, $2, $3, $4, $5);
