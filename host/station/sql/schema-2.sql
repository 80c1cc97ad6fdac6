-- What yields and failures are told from. A run is entered in the transaction that ends it, and all follows from the runs.

-- Runs that are over, by the day on which they began; a day has 86400000 milliseconds.
CREATE TABLE day_count (
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  station TEXT NOT NULL,
  lane TEXT NOT NULL,
  day {int} NOT NULL,
  runs {int} NOT NULL,
  errors {int} NOT NULL,
  crashes {int} NOT NULL,
  -- Units that were judged for the first time, and those of them that passed.
  units {int} NOT NULL,
  passed {int} NOT NULL,
  PRIMARY KEY (plan_sha256, station, lane, day)
){strict};

INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed)
SELECT plan_sha256, station, lane, started_ms / 86400000,
  count(*),
  count(*) FILTER (WHERE verdict = 'ERROR'),
  count(*) FILTER (WHERE cause = 'crash'),
  count(*) FILTER (WHERE verdict <> 'ERROR' AND nth = 1),
  count(*) FILTER (WHERE verdict = 'PASS' AND nth = 1)
FROM run
WHERE verdict IS NOT NULL
GROUP BY plan_sha256, station, lane, started_ms / 86400000;

-- Units that were judged more than once under plans of one name: the first judgement and the last.
CREATE TABLE retest (
  unit_id TEXT NOT NULL REFERENCES unit (id),
  plan TEXT NOT NULL,
  judgements {int} NOT NULL,
  first_run TEXT NOT NULL REFERENCES run (id),
  first_plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  station TEXT NOT NULL,
  lane TEXT NOT NULL,
  first_ms {int} NOT NULL,
  first_verdict TEXT NOT NULL CHECK (first_verdict IN ('PASS', 'FAIL')),
  last_run TEXT NOT NULL REFERENCES run (id),
  last_ms {int} NOT NULL,
  last_verdict TEXT NOT NULL CHECK (last_verdict IN ('PASS', 'FAIL')),
  PRIMARY KEY (unit_id, plan)
){strict};

INSERT INTO retest (unit_id, plan, judgements, first_run, first_plan_sha256, station, lane, first_ms, first_verdict,
  last_run, last_ms, last_verdict)
SELECT again.unit_id, theirs.name, again.nth, earliest.id, earliest.plan_sha256, earliest.station, earliest.lane,
  earliest.started_ms, earliest.verdict, again.id, again.started_ms, again.verdict
FROM run AS again
JOIN plan AS theirs ON theirs.sha256 = again.plan_sha256
JOIN run AS earliest ON earliest.unit_id = again.unit_id AND earliest.nth = 1 AND earliest.verdict <> 'ERROR'
JOIN plan AS ours ON ours.sha256 = earliest.plan_sha256 AND ours.name = theirs.name AND ours.product = theirs.product
WHERE again.nth >= 2 AND again.verdict <> 'ERROR' AND NOT EXISTS (
  SELECT 1 FROM run AS later
  JOIN plan AS latest ON latest.sha256 = later.plan_sha256
  WHERE later.unit_id = again.unit_id AND later.nth > again.nth AND later.verdict <> 'ERROR'
    AND latest.name = theirs.name AND latest.product = theirs.product
);

-- What each FAIL failed by: the part that is suspected first, or '' for none; and every check.
CREATE TABLE failure (
  run_id TEXT NOT NULL REFERENCES run (id),
  kind TEXT NOT NULL CHECK (kind IN ('part', 'check')),
  name TEXT NOT NULL,
  unit_id TEXT NOT NULL REFERENCES unit (id),
  plan_sha256 TEXT NOT NULL REFERENCES plan (sha256),
  lane TEXT NOT NULL,
  started_ms {int} NOT NULL,
  PRIMARY KEY (run_id, kind, name)
){strict};

INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms)
SELECT run.id, 'part', coalesce(suspect.part, ''), run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
LEFT JOIN suspect ON suspect.run_id = run.id AND suspect.rank = 1
WHERE run.verdict = 'FAIL';

-- A limit that blames the board, or a step that failed by more than its limits.
INSERT INTO failure (run_id, kind, name, unit_id, plan_sha256, lane, started_ms)
SELECT run.id, 'check', measurement.name, run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
JOIN measurement ON measurement.run_id = run.id AND measurement.outcome = 'failed' AND measurement.blames = 'board'
WHERE run.verdict = 'FAIL'
UNION
SELECT run.id, 'check', step.name, run.unit_id, run.plan_sha256, run.lane, run.started_ms
FROM run
JOIN step ON step.run_id = run.id AND step.outcome = 'failed'
WHERE run.verdict = 'FAIL' AND (
  NOT EXISTS (
    SELECT 1 FROM measurement
    WHERE measurement.run_id = step.run_id AND measurement.seq = step.seq
      AND measurement.outcome = 'failed' AND measurement.blames = 'board'
  )
  OR EXISTS (
    SELECT 1 FROM measurement
    WHERE measurement.run_id = step.run_id AND measurement.seq = step.seq AND measurement.attempt = step.attempt
      AND measurement.name = 'frames.samples_differing' AND measurement.value > 0
  )
);

-- Unit after unit, so that units are counted without being sorted.
CREATE INDEX failure_unit ON failure (kind, unit_id, run_id, name, started_ms, lane, plan_sha256);

-- Pages of runs by one filter. What the other filters ask for stands in the index, too, so that no row is read in vain.
DROP INDEX run_operator;
DROP INDEX run_lane;
DROP INDEX run_plan;
DROP INDEX run_verdict;
CREATE INDEX run_operator ON run (operator_id, started_ms DESC, id DESC, lane, verdict);
CREATE INDEX run_lane ON run (lane, started_ms DESC, id DESC, operator_id, verdict);
CREATE INDEX run_plan ON run (plan_sha256, started_ms DESC, id DESC, operator_id, lane, verdict);
CREATE INDEX run_verdict ON run (verdict, started_ms DESC, id DESC, operator_id, lane);

-- The fence of a lane's last holder.
CREATE INDEX run_fence ON run (station, lane, fence);

DROP INDEX run_yield;
DROP INDEX run_again;
DROP INDEX run_failed;
