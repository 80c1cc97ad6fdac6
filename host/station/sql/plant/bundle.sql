SELECT text FROM bundle WHERE sha256 = $1;
