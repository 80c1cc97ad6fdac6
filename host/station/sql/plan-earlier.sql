UPDATE plan SET first_used_ms = $1 WHERE first_used_ms > $1 AND sha256 = $2;
