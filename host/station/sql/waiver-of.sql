SELECT run_id, at_ms, operator_id, reason FROM waiver WHERE run_id = $1 ORDER BY id;
