SELECT kind, holder, id FROM waiter
WHERE until_ms >= {now_ms}
ORDER BY kind, id;
