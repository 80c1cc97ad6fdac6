SELECT id, product FROM unit WHERE serial = $1 ORDER BY product;
