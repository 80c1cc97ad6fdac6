-- When the newest run began, by the clock of its time: its id may say later, for ids are in order.
SELECT (SELECT started_ms FROM run ORDER BY id DESC LIMIT 1);
