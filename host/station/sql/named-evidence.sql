SELECT record_sha256 FROM run WHERE record_sha256 IS NOT NULL
UNION
SELECT sha256 FROM attachment;
