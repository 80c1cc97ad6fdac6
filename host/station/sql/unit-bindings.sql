SELECT device, from_ms, to_ms, by_operator, reason FROM binding WHERE unit_id = $1 ORDER BY from_ms DESC, id DESC;
