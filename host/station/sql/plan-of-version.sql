-- The newest other plan of a product, a name and a version.
SELECT sha256 FROM plan WHERE product = $1 AND name = $2 AND version = $3 AND sha256 <> $4 ORDER BY first_used_ms DESC LIMIT 1;
