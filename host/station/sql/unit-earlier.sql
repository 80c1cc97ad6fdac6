UPDATE unit SET first_seen_ms = $1 WHERE first_seen_ms > $1 AND id = $2;
