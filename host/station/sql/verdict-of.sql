SELECT verdict, exit_code, record_sha256, nth FROM run WHERE id = $1 AND state = 'final';
