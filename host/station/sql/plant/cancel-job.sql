UPDATE job SET state = 'dead', said = $1, holder = NULL, until_ms = NULL WHERE id = $2 AND state IN ('waiting', 'claimed');
