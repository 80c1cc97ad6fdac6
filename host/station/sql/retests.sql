SELECT serial, first_plan_sha256, station, lane, judgements, first_run, first_ms, first_verdict, last_run, last_ms, last_verdict
FROM retest
JOIN unit ON unit.id = retest.unit_id
WHERE first_ms >= $1 AND first_ms < $2;
