SELECT count(*) FROM board WHERE kind = $1 AND station IN ('', $2) AND out IS NULL;
