-- Plans with every file that they name, by their hashes.
CREATE TABLE bundle (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  text TEXT NOT NULL
){strict};

-- Which plan of a name holds: that of the highest number, as an engineer has signed it.
CREATE TABLE publication (
  product TEXT NOT NULL,
  name TEXT NOT NULL,
  number {int} NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL REFERENCES bundle (sha256),
  -- What is signed, and by which key.
  statement TEXT NOT NULL,
  signature TEXT NOT NULL,
  at_ms {int} NOT NULL,
  PRIMARY KEY (product, name, number)
){strict};
