INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome)
VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10);
