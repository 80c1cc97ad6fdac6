DELETE FROM waiter WHERE id = $1 OR until_ms < {now_ms};
