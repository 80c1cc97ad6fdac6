SELECT text FROM record WHERE sha256 = $1;
