-- The last judgement of a unit under a plan. One from before a person bound the unit, or what was its device, anew may be of another
-- board, or of this one before it was repaired. A binding has the id of the run or of the line in the audit that made it, and ends at
-- the time of the change that ends it. The changes have an index, unlike the rest of the audit, through which the way by the ids would lead.
SELECT run.verdict, run.id, run.ended_ms FROM run
JOIN unit ON unit.id = run.unit_id
WHERE unit.product = $1 AND unit.serial = $2 AND run.plan_sha256 = $3 AND run.nth > 0 AND run.verdict IN ('PASS', 'FAIL')
  AND NOT EXISTS (
    SELECT 1 FROM audit
    WHERE audit.act = 'rebind' AND audit.id || '' > run.id AND (audit.subject = unit.id OR audit.at_ms IN (
      SELECT binding.to_ms FROM binding WHERE binding.id IN (
        SELECT bound.id FROM run AS bound WHERE bound.unit_id = unit.id
        UNION ALL
        SELECT line.id FROM audit AS line WHERE line.act = 'rebind' AND line.subject = unit.id
      )
    ))
  )
ORDER BY run.id DESC LIMIT 1;
