-- The runs of which waiver and audit tell different things. One of the two may still be on its way, so that neither is missed.
SELECT waiver.run_id FROM waiver
JOIN audit ON audit.act = 'waive' AND audit.subject = waiver.run_id
WHERE NOT EXISTS (
  SELECT 1 FROM audit AS its
  WHERE its.act = 'waive' AND its.subject = waiver.run_id AND its.at_ms = waiver.at_ms
    AND its.operator_id = waiver.operator_id AND its.detail = waiver.reason
) AND NOT EXISTS (
  SELECT 1 FROM waiver AS its
  WHERE its.run_id = audit.subject AND its.at_ms = audit.at_ms
    AND its.operator_id = audit.operator_id AND its.reason = audit.detail
)
GROUP BY waiver.run_id
ORDER BY waiver.run_id;
