-- The runs to which this waiver, or this line of the audit about a unit, belongs no longer count as sent to the sink.
UPDATE outbox SET done_ms = NULL, attempts = 0, next_ms = 0
WHERE sink = $1 AND kind = 'run' AND done_ms IS NOT NULL AND subject IN (
  SELECT run_id FROM waiver WHERE id = $2
  UNION ALL
  SELECT run.id FROM run JOIN audit ON audit.subject = run.unit_id WHERE audit.id = $2
);
