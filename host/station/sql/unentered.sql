-- All that was kept and has no entry for this sink.
SELECT kind, subject FROM (
  SELECT 'run' AS kind, id AS subject FROM run WHERE state = 'final'
  UNION ALL SELECT 'waiver', id FROM waiver
  UNION ALL SELECT 'audit', id FROM audit
) AS kept
WHERE NOT EXISTS (
  SELECT 1 FROM outbox
  WHERE outbox.sink = $1 AND outbox.kind = kept.kind AND outbox.subject = kept.subject
)
