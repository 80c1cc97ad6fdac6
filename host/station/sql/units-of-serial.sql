SELECT id, product, serial, first_seen_ms FROM unit WHERE serial = $1 ORDER BY product;
