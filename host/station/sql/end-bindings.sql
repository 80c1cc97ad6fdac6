UPDATE binding SET to_ms = $1 WHERE to_ms IS NULL AND (unit_id = $2 OR device = $3);
