DELETE FROM measurement WHERE run_id > $1 AND run_id <= $2;
