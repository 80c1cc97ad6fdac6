SELECT id, at_ms, operator_id, subject, detail FROM audit WHERE act = $1 ORDER BY id;
