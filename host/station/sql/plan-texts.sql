SELECT sha256, product, text FROM plan ORDER BY sha256;
