INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail)
VALUES ($1, $2, $3, $4, $5, $6, $7, $8);
