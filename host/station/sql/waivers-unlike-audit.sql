-- The runs whose waiver is not the one in the audit, and those of which only one of the two is there.
SELECT waiver.run_id FROM waiver
LEFT JOIN audit ON audit.act = 'waive' AND audit.subject = waiver.run_id AND audit.at_ms = waiver.at_ms
  AND audit.operator_id = waiver.operator_id AND audit.detail = waiver.reason
WHERE audit.id IS NULL
UNION
SELECT audit.subject FROM audit
LEFT JOIN waiver ON waiver.run_id = audit.subject AND waiver.at_ms = audit.at_ms
  AND waiver.operator_id = audit.operator_id AND waiver.reason = audit.detail
WHERE audit.act = 'waive' AND waiver.id IS NULL
ORDER BY 1;
