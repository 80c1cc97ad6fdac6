UPDATE board SET out = $1 WHERE name = $2;
