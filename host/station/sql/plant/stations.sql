-- Every station that was ever heard of, with when its last run began.
SELECT station.name, station.program, station.plans, station.unsent, station.dead, station.seen_ms,
  (SELECT max(run.started_ms) FROM run WHERE run.station = station.name),
  {now_ms}
FROM station
ORDER BY station.name;
