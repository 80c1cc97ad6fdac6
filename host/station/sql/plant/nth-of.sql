SELECT nth FROM run WHERE id = $1;
