SELECT id FROM unit WHERE product = $1 AND serial = $2;
