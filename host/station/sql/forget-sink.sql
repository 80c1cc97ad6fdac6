DELETE FROM outbox WHERE sink = $1;
