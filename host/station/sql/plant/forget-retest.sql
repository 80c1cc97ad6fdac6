DELETE FROM retest WHERE unit_id = $1 AND plan = $2;
