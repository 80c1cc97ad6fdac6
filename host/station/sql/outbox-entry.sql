SELECT done_ms, dead_ms, said FROM outbox WHERE sink = $1 AND kind = $2 AND subject = $3;
