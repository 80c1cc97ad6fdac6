SELECT sha256, product, name, version FROM plan ORDER BY product, name, first_used_ms, sha256;
