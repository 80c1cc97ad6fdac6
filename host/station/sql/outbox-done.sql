UPDATE outbox SET done_ms = $1, dead_ms = NULL, said = NULL WHERE sink = $2 AND kind = $3 AND subject = $4;
