-- The tables of a station and of a plant. {int}, {real} and {strict} are what the two engines call differently.
CREATE TABLE plan (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  name TEXT NOT NULL,
  version TEXT NOT NULL,
  product TEXT NOT NULL,
  text TEXT NOT NULL,
  first_used_ms {int} NOT NULL
){strict};

CREATE TABLE unit (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  product TEXT NOT NULL,
  serial TEXT NOT NULL,
  first_seen_ms {int} NOT NULL,
  UNIQUE (product, serial)
){strict};

CREATE INDEX unit_serial ON unit (serial);

CREATE TABLE run (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  station TEXT NOT NULL,
  lane TEXT NOT NULL,
  unit_id TEXT NOT NULL REFERENCES unit (id),
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  variant TEXT NOT NULL,
  operator_id TEXT NOT NULL,
  target TEXT NOT NULL,
  board_kind TEXT,
  device TEXT,
  build TEXT,
  retest_of TEXT REFERENCES run (id),
  nth {int} NOT NULL,
  fence {int} NOT NULL,
  started_ms {int} NOT NULL,
  ended_ms {int},
  state TEXT NOT NULL CHECK (state IN ('open', 'final')),
  verdict TEXT CHECK (verdict IN ('PASS', 'FAIL', 'ERROR')),
  exit_code {int},
  cause TEXT CHECK (cause IN ('none', 'board', 'link', 'station', 'operator', 'crash', 'refused')),
  headline TEXT,
  record_sha256 TEXT CHECK (length(record_sha256) = 64),
  CHECK ((state = 'final') = (verdict IS NOT NULL)),
  CHECK ((state = 'final') = (exit_code IS NOT NULL AND cause IS NOT NULL)),
  CHECK ((state = 'final') = (ended_ms IS NOT NULL AND record_sha256 IS NOT NULL)),
  CHECK ((verdict = 'PASS') = (cause = 'none')),
  CHECK ((verdict = 'FAIL') = (cause = 'board'))
){strict};

-- Pages of runs, by each filter, in the order in which they are shown.
CREATE INDEX run_time ON run (started_ms DESC, id DESC);
CREATE INDEX run_unit ON run (unit_id, started_ms DESC, id DESC);
CREATE INDEX run_operator ON run (operator_id, started_ms DESC, id DESC);
CREATE INDEX run_lane ON run (lane, started_ms DESC, id DESC);
CREATE INDEX run_plan ON run (plan_sha256, started_ms DESC, id DESC);
CREATE INDEX run_verdict ON run (verdict, started_ms DESC, id DESC);
-- All that yield counts, in the order in which it is counted; a day has 86400000 milliseconds.
CREATE INDEX run_yield ON run (plan_sha256, station, lane, (started_ms / 86400000), verdict, nth, cause, started_ms);
CREATE INDEX run_again ON run (unit_id, nth, verdict, plan_sha256, started_ms, id) WHERE nth >= 2;
CREATE INDEX run_failed ON run (verdict, unit_id, id, plan_sha256, lane, started_ms) WHERE verdict = 'FAIL';
CREATE UNIQUE INDEX run_open_lane ON run (station, lane) WHERE state = 'open';
CREATE UNIQUE INDEX run_open_unit ON run (unit_id) WHERE state = 'open';

CREATE TABLE step (
  run_id TEXT NOT NULL REFERENCES run (id),
  seq {int} NOT NULL,
  attempt {int} NOT NULL,
  name TEXT NOT NULL,
  outcome TEXT NOT NULL CHECK (outcome IN ('passed', 'failed', 'error', 'skipped')),
  started_ms {int} NOT NULL,
  ended_ms {int} NOT NULL,
  detail TEXT NOT NULL,
  PRIMARY KEY (run_id, seq, attempt)
){strict};

CREATE INDEX step_failed ON step (run_id, seq, name) WHERE outcome = 'failed';

-- Those of the run as a whole have the number 0 in the place of a step's.
CREATE TABLE measurement (
  run_id TEXT NOT NULL REFERENCES run (id),
  seq {int} NOT NULL,
  attempt {int} NOT NULL,
  name TEXT NOT NULL,
  value {real},
  unit TEXT NOT NULL,
  low {real},
  high {real},
  blames TEXT NOT NULL CHECK (blames IN ('board', 'station', 'nobody')),
  outcome TEXT NOT NULL CHECK (outcome IN ('passed', 'failed', 'unset', 'not judged')),
  PRIMARY KEY (run_id, seq, attempt, name)
){strict};

CREATE INDEX measurement_failed ON measurement (run_id, seq, name) WHERE outcome = 'failed' AND blames = 'board';

CREATE TABLE suspect (
  run_id TEXT NOT NULL REFERENCES run (id),
  rank {int} NOT NULL,
  part TEXT NOT NULL,
  place TEXT NOT NULL,
  explained {real} NOT NULL,
  PRIMARY KEY (run_id, rank)
){strict};

CREATE TABLE attachment (
  run_id TEXT NOT NULL REFERENCES run (id),
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
  bytes {int} NOT NULL,
  media_type TEXT NOT NULL,
  PRIMARY KEY (run_id, name)
){strict};

CREATE TABLE waiver (
  id TEXT PRIMARY KEY,
  run_id TEXT NOT NULL REFERENCES run (id),
  at_ms {int} NOT NULL,
  operator_id TEXT NOT NULL,
  reason TEXT NOT NULL
){strict};

CREATE INDEX waiver_run ON waiver (run_id);

-- Which device has which serial number, from when to when. What a run bound has the id of the run; what a person bound has
-- that of its line in the audit.
CREATE TABLE binding (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  device TEXT NOT NULL CHECK (length(device) = 16),
  unit_id TEXT NOT NULL REFERENCES unit (id),
  from_ms {int} NOT NULL,
  to_ms {int},
  by_operator TEXT NOT NULL,
  reason TEXT NOT NULL
){strict};

CREATE UNIQUE INDEX binding_device_now ON binding (device) WHERE to_ms IS NULL;
CREATE UNIQUE INDEX binding_unit_now ON binding (unit_id) WHERE to_ms IS NULL;

CREATE TABLE audit (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  at_ms {int} NOT NULL,
  operator_id TEXT NOT NULL,
  act TEXT NOT NULL,
  subject TEXT NOT NULL,
  detail TEXT NOT NULL
){strict};
