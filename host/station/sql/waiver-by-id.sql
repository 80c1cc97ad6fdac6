SELECT run_id, at_ms, operator_id, reason FROM waiver WHERE id = $1;
