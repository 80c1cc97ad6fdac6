SELECT name FROM board WHERE product = $1 AND serial = $2 AND serial <> '' AND name <> $3;
