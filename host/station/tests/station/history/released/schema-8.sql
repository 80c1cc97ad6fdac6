PRAGMA foreign_keys = OFF;
CREATE TABLE schema_version (
  n INTEGER PRIMARY KEY,
  sha256 TEXT NOT NULL,
  applied_ms INTEGER NOT NULL
) STRICT;
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (1, '14eef3bbcbdb34e1165dded06a931507dc5c5505d8b79e165e75be94bec6921e', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (2, 'eb2eca6c66b4c03f0c998d97b8ddb433f2d4a278dd9ccc9f3b9699e2d14666b5', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (3, '16942044da24a1d9b3e80a2be3eebf0c0aeda9604d2c591f3223f2ebcd87661b', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (4, 'fb2be50abeee588061c8a41d48cb29f9010f7a85a3373078f9a052f60427cb86', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (5, '0445e000d0a29583b4f79c5008cac9c17d3d070e034817b2259071a558079d87', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (6, 'eccc7db7598979156ec2abf199a0d2c58af8e6fc1121551a5357d8a9369610b8', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (7, 'fbaefaf28fefffbd86523ffa6465aa57e329ae085c18df3f0ceda964bc172739', 1793491200000);
INSERT INTO schema_version (n, sha256, applied_ms) VALUES (8, 'a87148ae4fe52133851ad4c8cbaf69277b2cf4390889ac01b8c267fe2b0e0970', 1793491200000);
CREATE TABLE plan (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  name TEXT NOT NULL,
  version TEXT NOT NULL,
  product TEXT NOT NULL,
  text TEXT NOT NULL,
  first_used_ms INTEGER NOT NULL
) STRICT;
INSERT INTO plan (sha256, name, version, product, text, first_used_ms) VALUES ('ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', 'final', '1', 'CAM-T', 'schema = 1 # final 1
', 1793491200000);
INSERT INTO plan (sha256, name, version, product, text, first_used_ms) VALUES ('21b5ee6e037b55ab6f3e47bb672a1e9e0c68c62975cb8f18ece23c649997c502', 'final', '2', 'CAM-T', 'schema = 1 # final 2
', 1793577600000);
CREATE TABLE unit (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  product TEXT NOT NULL,
  serial TEXT NOT NULL,
  first_seen_ms INTEGER NOT NULL,
  UNIQUE (product, serial)
) STRICT;
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a19467-e800-700f-8241-000000000000', 'CAM-T', 'S1', 1793491200000);
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a194d5-c500-700f-8243-000000000000', 'CAM-T', 'S2', 1793498400000);
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a1950c-b380-700f-8244-000000000000', 'CAM-T', 'S3', 1793502000000);
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a199c5-3280-700f-8246-000000000000', 'CAM-T', 'S4', 1793581200000);
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a199fc-2100-700f-8247-000000000000', 'CAM-T', 'S5', 1793584800000);
INSERT INTO unit (id, product, serial, first_seen_ms) VALUES ('01a19a33-0f80-700f-8248-000000000000', 'CAM-T', 'S6', 1793588400000);
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
  nth INTEGER NOT NULL,
  fence INTEGER NOT NULL,
  started_ms INTEGER NOT NULL,
  ended_ms INTEGER,
  state TEXT NOT NULL CHECK (state IN ('open', 'final')),
  verdict TEXT CHECK (verdict IN ('PASS', 'FAIL', 'ERROR')),
  exit_code INTEGER,
  cause TEXT CHECK (cause IN ('none', 'board', 'link', 'station', 'operator', 'crash', 'refused')),
  headline TEXT,
  record_sha256 TEXT CHECK (length(record_sha256) = 64),
  CHECK ((state = 'final') = (verdict IS NOT NULL)),
  CHECK ((state = 'final') = (exit_code IS NOT NULL AND cause IS NOT NULL)),
  CHECK ((state = 'final') = (ended_ms IS NOT NULL AND record_sha256 IS NOT NULL)),
  CHECK ((verdict = 'PASS') = (cause = 'none')),
  CHECK ((verdict = 'FAIL') = (cause = 'board'))
) STRICT;
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a19467-e800-7000-8001-000000000000', 'station 7', '1', '01a19467-e800-700f-8241-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 1, 1793491200000, 1793491201500, 'final', 'FAIL', 1, 'board', 'it is FAIL, "as" made', '26d0b0874b2c3cbe5742844b1ee43d00d92928aefeb453d187ebf3be974c2254');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a1949e-d680-7000-8002-000000000000', 'station 7', '1', '01a19467-e800-700f-8241-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 2, 2, 1793494800000, 1793494801500, 'final', 'PASS', 0, 'none', 'it is PASS, "as" made', '6b34b815039e424deb2d057bff86bdc70c8e27a61fc9aa42d8474c4224b41b3c');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a194d5-c500-7000-8003-000000000000', 'station 7', '2', '01a194d5-c500-700f-8243-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 1, 1793498400000, 1793498401500, 'final', 'PASS', 0, 'none', 'it is PASS, "as" made', '147b1417aa5e2b6e953c8ba84aae11baaab144ef5ca0e643544ccd47f6400376');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a1950c-b380-7000-8004-000000000000', 'station 7', '1', '01a1950c-b380-700f-8244-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 3, 1793502000000, 1793502001500, 'final', 'ERROR', 3, 'crash', 'it is ERROR, "as" made', 'b356234453254b37c335a0bb2b4d52cd689989d7ba8be2abed4f423e7b850595');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a1998e-4400-7000-8005-000000000000', 'station 7', '1', '01a1950c-b380-700f-8244-000000000000', '21b5ee6e037b55ab6f3e47bb672a1e9e0c68c62975cb8f18ece23c649997c502', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 4, 1793577600000, 1793577601500, 'final', 'PASS', 0, 'none', 'it is PASS, "as" made', '91ef4c55f8f03678b3a30d9947558eec3fa5a2dc87d35162bdc697624278625e');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a199c5-3280-7000-8006-000000000000', 'station 7', '1', '01a199c5-3280-700f-8246-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'O''Neil, "J"
<&>', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 5, 1793581200000, 1793581201500, 'final', 'FAIL', 1, 'board', 'it is FAIL, "as" made', '495cef790a0b9aee3ad0c9f4fa1df410d7780db55ff1bb672693291f0f1e5ee5');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a199fc-2100-7000-8007-000000000000', 'station 7', '1', '01a199fc-2100-700f-8247-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', 'hardware', '0123456789abcdef', '99bff58a', NULL, 1, 6, 1793584800000, 1793584801500, 'final', 'ERROR', 3, 'operator', 'it is ERROR, "as" made', '6e357422568941834ee49e193ba6423638fdd72b3643ef1feb3673fefe1cdb8c');
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, board_kind, device, build, retest_of, nth, fence, started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256) VALUES ('01a19a33-0f80-7000-8008-000000000000', 'station 7', '1', '01a19a33-0f80-700f-8248-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '', 'weber', 'usb:1-2.3', NULL, NULL, NULL, NULL, 0, 7, 1793588400000, NULL, 'open', NULL, NULL, NULL, NULL, NULL);
CREATE TABLE step (
  run_id TEXT NOT NULL REFERENCES run (id),
  seq INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  name TEXT NOT NULL,
  outcome TEXT NOT NULL CHECK (outcome IN ('passed', 'failed', 'error', 'skipped')),
  started_ms INTEGER NOT NULL,
  ended_ms INTEGER NOT NULL,
  detail TEXT NOT NULL,
  PRIMARY KEY (run_id, seq, attempt)
) STRICT;
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a19467-e800-7000-8001-000000000000', 1, 1, 'identity', 'passed', 1793491200000, 1793491200500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'verify', 'failed', 1793491200500, 1793491201000, 'verify "failed", <board>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1949e-d680-7000-8002-000000000000', 1, 1, 'identity', 'passed', 1793494800000, 1793494800500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'verify', 'passed', 1793494800500, 1793494801000, 'verify "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a194d5-c500-7000-8003-000000000000', 1, 1, 'identity', 'passed', 1793498400000, 1793498400500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'verify', 'passed', 1793498400500, 1793498401000, 'verify "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1950c-b380-7000-8004-000000000000', 1, 1, 'identity', 'passed', 1793502000000, 1793502000500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'verify', 'error', 1793502000500, 1793502001000, 'verify "error", <crash>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1998e-4400-7000-8005-000000000000', 1, 1, 'identity', 'passed', 1793577600000, 1793577600500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'verify', 'passed', 1793577600500, 1793577601000, 'verify "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a199c5-3280-7000-8006-000000000000', 1, 1, 'identity', 'passed', 1793581200000, 1793581200500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'verify', 'failed', 1793581200500, 1793581201000, 'verify "failed", <board>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a199fc-2100-7000-8007-000000000000', 1, 1, 'identity', 'passed', 1793584800000, 1793584800500, 'identity "passed", <none>');
INSERT INTO step (run_id, seq, attempt, name, outcome, started_ms, ended_ms, detail) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'verify', 'error', 1793584800500, 1793584801000, 'verify "error", <operator>');
CREATE TABLE measurement (
  run_id TEXT NOT NULL REFERENCES run (id),
  seq INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  name TEXT NOT NULL,
  value REAL,
  unit TEXT NOT NULL,
  low REAL,
  high REAL,
  blames TEXT NOT NULL CHECK (blames IN ('board', 'station', 'nobody')),
  outcome TEXT NOT NULL CHECK (outcome IN ('passed', 'failed', 'unset', 'not judged')),
  PRIMARY KEY (run_id, seq, attempt, name)
) STRICT;
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 1, 'frames.samples_differing', 5.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a19467-e800-7000-8001-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1949e-d680-7000-8002-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a194d5-c500-7000-8003-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1950c-b380-7000-8004-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a1998e-4400-7000-8005-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'latency.clocks', 1005.5, 'clocks', NULL, 1004.0, 'board', 'failed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199c5-3280-7000-8006-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'latency.clocks', 1004.0, 'clocks', NULL, 1004.0, 'board', 'passed');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'latency.microseconds', NULL, 'us', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'verify.retries', NULL, '1', NULL, NULL, 'station', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'verify.seconds', NULL, 's', NULL, NULL, 'nobody', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 2, 1, 'frames.samples_differing', 0.0, '1', NULL, NULL, 'board', 'not judged');
INSERT INTO measurement (run_id, seq, attempt, name, value, unit, low, high, blames, outcome) VALUES ('01a199fc-2100-7000-8007-000000000000', 0, 1, 'run.seconds', 1.5, 's', NULL, NULL, 'nobody', 'not judged');
CREATE TABLE suspect (
  run_id TEXT NOT NULL REFERENCES run (id),
  rank INTEGER NOT NULL,
  part TEXT NOT NULL,
  place TEXT NOT NULL,
  explained REAL NOT NULL,
  PRIMARY KEY (run_id, rank)
) STRICT;
INSERT INTO suspect (run_id, rank, part, place, explained) VALUES ('01a19467-e800-7000-8001-000000000000', 1, 'memory', 'bit 3', 0.75);
INSERT INTO suspect (run_id, rank, part, place, explained) VALUES ('01a19467-e800-7000-8001-000000000000', 2, 'clock', 'bit 3', 0.75);
CREATE TABLE attachment (
  run_id TEXT NOT NULL REFERENCES run (id),
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
  bytes INTEGER NOT NULL,
  media_type TEXT NOT NULL,
  PRIMARY KEY (run_id, name)
) STRICT;
INSERT INTO attachment (run_id, name, sha256, bytes, media_type) VALUES ('01a19467-e800-7000-8001-000000000000', 'what it told.txt', '0ea14c28f90e157d53db60a322c7b9f7a35fa206bdf69596e06904a89d5d6632', 12, 'text/plain');
INSERT INTO attachment (run_id, name, sha256, bytes, media_type) VALUES ('01a19467-e800-7000-8001-000000000000', 'what it logged.txt', '7e78d93d9ca96885ec11097c5b1058008b1895700eeadc38a49686b6431f92a0', 14, 'text/plain');
CREATE TABLE waiver (
  id TEXT PRIMARY KEY,
  run_id TEXT NOT NULL REFERENCES run (id),
  at_ms INTEGER NOT NULL,
  operator_id TEXT NOT NULL,
  reason TEXT NOT NULL
) STRICT;
INSERT INTO waiver (id, run_id, at_ms, operator_id, reason) VALUES ('01a22db3-ffb7-7b76-9ec6-17dcb7bf0857', '01a19467-e800-7000-8001-000000000000', 1796063100855, 'engel', 'it''s "as" is');
CREATE TABLE binding (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  device TEXT NOT NULL CHECK (length(device) = 16),
  unit_id TEXT NOT NULL REFERENCES unit (id),
  from_ms INTEGER NOT NULL,
  to_ms INTEGER,
  by_operator TEXT NOT NULL,
  reason TEXT NOT NULL
) STRICT;
INSERT INTO binding (id, device, unit_id, from_ms, to_ms, by_operator, reason) VALUES ('01a22db3-ffbf-70e0-a718-525bd2d7a341', '00a1b2c3d4e5f607', '01a194d5-c500-700f-8243-000000000000', 1796063100863, NULL, 'engel', 'a new FPGA');
CREATE TABLE audit (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  at_ms INTEGER NOT NULL,
  operator_id TEXT NOT NULL,
  act TEXT NOT NULL,
  subject TEXT NOT NULL,
  detail TEXT NOT NULL
) STRICT;
INSERT INTO audit (id, at_ms, operator_id, act, subject, detail) VALUES ('01a22db3-ffb7-7d57-ae2a-a009d15f3470', 1796063100855, 'engel', 'waive', '01a19467-e800-7000-8001-000000000000', 'it''s "as" is');
INSERT INTO audit (id, at_ms, operator_id, act, subject, detail) VALUES ('01a22db3-ffbf-70e0-a718-525bd2d7a341', 1796063100863, 'engel', 'rebind', '01a194d5-c500-700f-8243-000000000000', '{"device":"00a1b2c3d4e5f607","reason":"a new FPGA"}');
CREATE TABLE day_count (
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  station TEXT NOT NULL,
  lane TEXT NOT NULL,
  day INTEGER NOT NULL,
  runs INTEGER NOT NULL,
  errors INTEGER NOT NULL,
  crashes INTEGER NOT NULL,
  -- Units that were judged for the first time, and those of them that passed.
  units INTEGER NOT NULL,
  passed INTEGER NOT NULL,
  PRIMARY KEY (plan_sha256, station, lane, day)
) STRICT;
INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed) VALUES ('ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', 'station 7', '1', 20758, 3, 1, 1, 1, 0);
INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed) VALUES ('ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', 'station 7', '2', 20758, 1, 0, 0, 1, 1);
INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed) VALUES ('21b5ee6e037b55ab6f3e47bb672a1e9e0c68c62975cb8f18ece23c649997c502', 'station 7', '1', 20759, 1, 0, 0, 1, 1);
INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed) VALUES ('ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', 'station 7', '1', 20759, 2, 1, 0, 1, 0);
CREATE TABLE retest (
  unit_id TEXT NOT NULL REFERENCES unit (id),
  plan TEXT NOT NULL,
  judgements INTEGER NOT NULL,
  first_run TEXT NOT NULL REFERENCES run (id),
  first_plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  station TEXT NOT NULL,
  lane TEXT NOT NULL,
  first_ms INTEGER NOT NULL,
  first_verdict TEXT NOT NULL CHECK (first_verdict IN ('PASS', 'FAIL')),
  last_run TEXT NOT NULL REFERENCES run (id),
  last_ms INTEGER NOT NULL,
  last_verdict TEXT NOT NULL CHECK (last_verdict IN ('PASS', 'FAIL')),
  PRIMARY KEY (unit_id, plan)
) STRICT;
INSERT INTO retest (unit_id, plan, judgements, first_run, first_plan_sha256, station, lane, first_ms, first_verdict, last_run, last_ms, last_verdict) VALUES ('01a19467-e800-700f-8241-000000000000', 'final', 2, '01a19467-e800-7000-8001-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', 'station 7', '1', 1793491200000, 'FAIL', '01a1949e-d680-7000-8002-000000000000', 1793494800000, 'PASS');
CREATE TABLE failure (
  run_id TEXT NOT NULL REFERENCES run (id),
  kind TEXT NOT NULL CHECK (kind IN ('part', 'check')),
  name TEXT NOT NULL,
  unit_id TEXT NOT NULL REFERENCES unit (id),
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  lane TEXT NOT NULL,
  started_ms INTEGER NOT NULL,
  PRIMARY KEY (run_id, kind, name)
) STRICT;
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms) VALUES ('01a19467-e800-7000-8001-000000000000', 'check', 'verify', '01a19467-e800-700f-8241-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '1', 1793491200000);
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms) VALUES ('01a19467-e800-7000-8001-000000000000', 'part', 'memory', '01a19467-e800-700f-8241-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '1', 1793491200000);
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms) VALUES ('01a199c5-3280-7000-8006-000000000000', 'check', 'latency.clocks', '01a199c5-3280-700f-8246-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '1', 1793581200000);
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms) VALUES ('01a199c5-3280-7000-8006-000000000000', 'part', '', '01a199c5-3280-700f-8246-000000000000', 'ed727ed8b78055130486121aa8593105c6fdfa45ce3193ba758e7bec1075f6c4', '1', 1793581200000);
CREATE TABLE outbox (
  sink TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('run', 'waiver', 'audit')),
  -- The id of the run, of the waiver, or of the line in the audit.
  subject TEXT NOT NULL CHECK (length(subject) = 36),
  attempts INTEGER NOT NULL,
  -- When it is tried next.
  next_ms INTEGER NOT NULL,
  -- When the other side had it for certain.
  done_ms INTEGER,
  -- When it was given to a person to look at.
  dead_ms INTEGER,
  -- What was said to the last try that failed.
  said TEXT,
  PRIMARY KEY (sink, kind, subject),
  CHECK (done_ms IS NULL OR dead_ms IS NULL)
) STRICT;
CREATE TABLE record (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  text TEXT NOT NULL
) STRICT;
CREATE TABLE origin (
  id TEXT PRIMARY KEY CHECK (length(id) = 36)
) STRICT;
CREATE TABLE station (
  name TEXT PRIMARY KEY,
  origin TEXT NOT NULL CHECK (length(origin) = 36),
  program TEXT NOT NULL,
  -- Its plans: product, name and version of each, one a line.
  plans TEXT NOT NULL,
  unsent INTEGER NOT NULL,
  dead INTEGER NOT NULL,
  seen_ms INTEGER NOT NULL
) STRICT;
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
  fence INTEGER NOT NULL,
  until_ms INTEGER,
  CHECK ((product = '') = (serial = ''))
) STRICT;
CREATE TABLE waiter (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  kind TEXT NOT NULL,
  holder TEXT NOT NULL,
  until_ms INTEGER NOT NULL
) STRICT;
CREATE TABLE job (
  id TEXT PRIMARY KEY CHECK (length(id) = 36),
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  product TEXT NOT NULL,
  -- The unit; empty if any board of the kind will do.
  serial TEXT NOT NULL,
  kind TEXT NOT NULL,
  -- What a station must have, with blanks between.
  needs TEXT NOT NULL,
  priority INTEGER NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('waiting', 'claimed', 'done', 'dead')),
  holder TEXT,
  -- How often it was claimed.
  fence INTEGER NOT NULL,
  until_ms INTEGER,
  -- How often it was claimed since a person last looked at it.
  attempts INTEGER NOT NULL,
  -- The run that counts.
  run_id TEXT UNIQUE,
  created_ms INTEGER NOT NULL,
  operator_id TEXT NOT NULL,
  -- Why it came to nothing, or to nothing yet.
  said TEXT,
  CHECK ((serial = '') <> (kind = ''))
) STRICT;
CREATE TABLE bundle (
  sha256 TEXT PRIMARY KEY CHECK (length(sha256) = 64),
  text TEXT NOT NULL
) STRICT;
CREATE TABLE publication (
  product TEXT NOT NULL,
  name TEXT NOT NULL,
  number INTEGER NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL REFERENCES bundle (sha256),
  -- What is signed, and by which key.
  statement TEXT NOT NULL,
  signature TEXT NOT NULL,
  at_ms INTEGER NOT NULL,
  PRIMARY KEY (product, name, number)
) STRICT;
CREATE TABLE mismatch (
  station TEXT NOT NULL,
  device TEXT NOT NULL CHECK (length(device) = 16),
  unit_id TEXT NOT NULL REFERENCES unit (id),
  -- The last run in which the station judged the one as the other, and when it began.
  run_id TEXT NOT NULL REFERENCES run (id),
  last_ms INTEGER NOT NULL,
  PRIMARY KEY (station, device, unit_id)
) STRICT;
CREATE INDEX unit_serial ON unit (serial);
CREATE INDEX run_time ON run (started_ms DESC, id DESC);
CREATE INDEX run_unit ON run (unit_id, started_ms DESC, id DESC);
CREATE UNIQUE INDEX run_open_lane ON run (station, lane) WHERE state = 'open';
CREATE UNIQUE INDEX run_open_unit ON run (unit_id) WHERE state = 'open';
CREATE INDEX step_failed ON step (run_id, seq, name) WHERE outcome = 'failed';
CREATE INDEX measurement_failed ON measurement (run_id, seq, name) WHERE outcome = 'failed' AND blames = 'board';
CREATE INDEX waiver_run ON waiver (run_id);
CREATE UNIQUE INDEX binding_device_now ON binding (device) WHERE to_ms IS NULL;
CREATE UNIQUE INDEX binding_unit_now ON binding (unit_id) WHERE to_ms IS NULL;
CREATE INDEX failure_unit ON failure (kind, unit_id, run_id, name, started_ms, lane, plan_sha256);
CREATE INDEX run_operator ON run (operator_id, started_ms DESC, id DESC, lane, verdict);
CREATE INDEX run_lane ON run (lane, started_ms DESC, id DESC, operator_id, verdict);
CREATE INDEX run_plan ON run (plan_sha256, started_ms DESC, id DESC, operator_id, lane, verdict);
CREATE INDEX run_verdict ON run (verdict, started_ms DESC, id DESC, operator_id, lane);
CREATE INDEX run_fence ON run (station, lane, fence);
CREATE INDEX outbox_open ON outbox (sink, subject) WHERE done_ms IS NULL;
CREATE INDEX run_station ON run (station, started_ms DESC, id DESC, lane, operator_id, verdict);
CREATE INDEX job_open ON job (priority DESC, id) WHERE state IN ('waiting', 'claimed');
CREATE INDEX binding_unit ON binding (unit_id, from_ms DESC, id DESC);
CREATE INDEX binding_device ON binding (device);
CREATE INDEX audit_rebind ON audit (subject, at_ms) WHERE act = 'rebind';
CREATE INDEX outbox_due ON outbox (sink, subject) WHERE done_ms IS NULL AND dead_ms IS NULL;
CREATE INDEX run_judged ON run (unit_id, plan_sha256, station, lane, id) WHERE verdict IN ('PASS', 'FAIL');
