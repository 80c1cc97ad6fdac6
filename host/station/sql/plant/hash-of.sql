-- The hash of a run's record, and whether that record is there.
SELECT run.record_sha256, EXISTS (SELECT 1 FROM record WHERE record.sha256 = run.record_sha256) FROM run WHERE run.id = $1;
