-- Enters for this sink all that was kept before and has no entry for it.
INSERT INTO outbox (sink, kind, subject, attempts, next_ms)
SELECT $1, kind, subject, 0, 0 FROM (
  SELECT 'run' AS kind, id AS subject FROM run WHERE state = 'final'
  UNION ALL SELECT 'waiver', id FROM waiver
  UNION ALL SELECT 'audit', id FROM audit
) AS kept
WHERE NOT EXISTS (
  SELECT 1 FROM outbox
  WHERE outbox.sink = $1 AND outbox.kind = kept.kind AND outbox.subject = kept.subject
)
ON CONFLICT (sink, kind, subject) DO NOTHING;
