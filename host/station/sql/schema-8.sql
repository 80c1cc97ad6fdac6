-- Units that check a shift are no products, and count nowhere, like the mock. Their runs have the number 0 by now: which ones these
-- are is in the texts of the plans, which the program reads. All that is counted follows from the runs.

-- A unit may check shifts by one version of a plan, and be a product by another.
UPDATE run SET nth = (
  SELECT 1 + count(*) FROM run AS earlier
  JOIN plan AS theirs ON theirs.sha256 = earlier.plan_sha256
  JOIN plan AS ours ON ours.sha256 = run.plan_sha256
  WHERE earlier.unit_id = run.unit_id AND theirs.name = ours.name AND theirs.product = ours.product
    AND earlier.id < run.id AND earlier.nth > 0 AND earlier.verdict IN ('PASS', 'FAIL')
)
WHERE nth > 0 AND unit_id IN (SELECT other.unit_id FROM run AS other WHERE other.nth = 0 AND other.state = 'final');

DELETE FROM day_count;
INSERT INTO day_count (plan_sha256, station, lane, day, runs, errors, crashes, units, passed)
SELECT plan_sha256, station, lane, started_ms / 86400000,
  count(*),
  count(*) FILTER (WHERE verdict = 'ERROR'),
  count(*) FILTER (WHERE cause = 'crash'),
  count(*) FILTER (WHERE verdict <> 'ERROR' AND nth = 1),
  count(*) FILTER (WHERE verdict = 'PASS' AND nth = 1)
FROM run
WHERE verdict IS NOT NULL AND nth > 0
GROUP BY plan_sha256, station, lane, started_ms / 86400000;

DELETE FROM retest;
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

-- What the other runs failed by stays as it was counted: a plant may have removed their steps since.
DELETE FROM failure WHERE run_id IN (SELECT id FROM run WHERE nth = 0);

-- Who judged a unit last in a lane, however often it is judged.
CREATE INDEX run_judged ON run (unit_id, plan_sha256, station, lane, id) WHERE verdict IN ('PASS', 'FAIL');
