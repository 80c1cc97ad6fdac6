UPDATE board SET holder = NULL, until_ms = NULL WHERE name = $1 AND holder = $2 AND fence = $3;
