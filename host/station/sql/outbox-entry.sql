SELECT done_ms FROM outbox WHERE sink = $1 AND kind = $2 AND subject = $3;
