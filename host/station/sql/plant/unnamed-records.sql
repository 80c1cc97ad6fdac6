SELECT sha256 FROM record
WHERE NOT EXISTS (SELECT 1 FROM run WHERE run.record_sha256 = record.sha256)
ORDER BY sha256;
