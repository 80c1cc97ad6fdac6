-- The next runs in the order in which they began, with their records.
SELECT run.id, run.unit_id, run.nth, run.record_sha256, record.text
FROM run
LEFT JOIN record ON record.sha256 = run.record_sha256
WHERE run.id > $1 AND run.state = 'final'
ORDER BY run.id
LIMIT 500;
