-- What is to be sent on, to whom, and what became of it. An entry is made in the transaction that keeps what is to be sent.
CREATE TABLE outbox (
  sink TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('run', 'waiver', 'audit')),
  -- The id of the run, of the waiver, or of the line in the audit.
  subject TEXT NOT NULL CHECK (length(subject) = 36),
  attempts {int} NOT NULL,
  -- When it is tried next.
  next_ms {int} NOT NULL,
  -- When the other side had it for certain.
  done_ms {int},
  -- When it was given to a person to look at.
  dead_ms {int},
  -- What was said to the last try that failed.
  said TEXT,
  PRIMARY KEY (sink, kind, subject),
  CHECK (done_ms IS NULL OR dead_ms IS NULL)
){strict};

CREATE INDEX outbox_open ON outbox (sink, subject) WHERE done_ms IS NULL;

-- Records by their hashes. A station keeps them as files.
CREATE TABLE record (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  text TEXT NOT NULL
){strict};
