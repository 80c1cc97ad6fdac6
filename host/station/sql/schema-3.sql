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

-- What the station's folder is called, whatever the station is: made once, so that two stations of one name are told apart.
CREATE TABLE origin (
  id TEXT PRIMARY KEY CHECK (length(id) = 36)
){strict};

-- Stations as a plant last heard of them.
CREATE TABLE station (
  name TEXT PRIMARY KEY,
  origin TEXT NOT NULL CHECK (length(origin) = 36),
  program TEXT NOT NULL,
  -- Its plans: product, name and version of each, one a line.
  plans TEXT NOT NULL,
  unsent {int} NOT NULL,
  dead {int} NOT NULL,
  seen_ms {int} NOT NULL
){strict};

CREATE INDEX run_station ON run (station, started_ms DESC, id DESC, lane, operator_id, verdict);
