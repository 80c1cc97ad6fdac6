DELETE FROM board WHERE name = $1;
