SELECT device FROM binding WHERE unit_id = $1 AND to_ms IS NULL;
