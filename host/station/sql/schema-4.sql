-- Boards that several computers share, each used by one at a time: whoever holds it until a moment, by the plant's clock.
CREATE TABLE board (
  name TEXT PRIMARY KEY,
  -- Whoever needs any board needs one of a kind.
  kind TEXT NOT NULL,
  -- Where it is, as a board is named everywhere.
  target TEXT NOT NULL,
  -- Which unit it is; empty if no plan judges it.
  product TEXT NOT NULL,
  serial TEXT NOT NULL,
  -- The one station that reaches it; empty if every one does.
  station TEXT NOT NULL,
  -- Why nobody may have it.
  out TEXT,
  holder TEXT,
  -- How often somebody got it.
  fence {int} NOT NULL,
  until_ms {int},
  CHECK ((product = '') = (serial = ''))
){strict};

-- Who waits for any board of a kind, in the order of the ids, and is known to wait until a moment.
CREATE TABLE waiter (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  kind TEXT NOT NULL,
  holder TEXT NOT NULL,
  until_ms {int} NOT NULL
){strict};

-- What whichever station is free is to judge.
CREATE TABLE job (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  product TEXT NOT NULL,
  -- The unit; empty if any board of the kind will do.
  serial TEXT NOT NULL,
  kind TEXT NOT NULL,
  -- What a station must have, with blanks between.
  needs TEXT NOT NULL,
  priority {int} NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('waiting', 'claimed', 'done', 'dead')),
  holder TEXT,
  -- How often it was claimed.
  fence {int} NOT NULL,
  until_ms {int},
  -- How often it was claimed since a person last looked at it.
  attempts {int} NOT NULL,
  -- The run that counts.
  run_id TEXT UNIQUE,
  created_ms {int} NOT NULL,
  operator_id TEXT NOT NULL,
  -- Why it came to nothing, or to nothing yet.
  said TEXT,
  CHECK ((serial = '') <> (kind = ''))
){strict};

CREATE INDEX job_open ON job (priority DESC, id) WHERE state IN ('waiting', 'claimed');
