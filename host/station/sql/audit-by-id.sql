-- A line of the audit, and the unit that it is about, if it is about one.
SELECT audit.at_ms, audit.operator_id, audit.act, audit.subject, audit.detail, unit.product, unit.serial
FROM audit
LEFT JOIN unit ON unit.id = audit.subject
WHERE audit.id = $1;
