UPDATE run SET nth = 0
WHERE plan_sha256 = $1 AND state = 'final' AND unit_id = (SELECT id FROM unit WHERE product = $2 AND serial = $3);
