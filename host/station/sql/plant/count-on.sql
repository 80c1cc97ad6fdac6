UPDATE run SET nth = nth + 1
WHERE unit_id = $1 AND id > $2 AND nth > 0
  AND plan_sha256 IN (SELECT sha256 FROM plan WHERE name = $3 AND product = $4);
