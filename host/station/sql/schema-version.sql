CREATE TABLE IF NOT EXISTS schema_version (
  n {int} PRIMARY KEY,
  sha256 TEXT NOT NULL,
  applied_ms {int} NOT NULL
){strict};
