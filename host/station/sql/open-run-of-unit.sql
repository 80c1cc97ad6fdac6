SELECT id FROM run WHERE unit_id = $1 AND state = 'open';
