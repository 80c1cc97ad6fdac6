SELECT serial FROM unit WHERE id = $1;
