SELECT id, record_sha256 FROM run WHERE state = 'final' ORDER BY id;
