-- Runs that are FAIL, by the day on which they began. Runs that count nowhere have the number 0.
SELECT plan_sha256, station, lane, started_ms / 86400000, count(*)
FROM run
WHERE verdict = 'FAIL' AND nth > 0 AND started_ms >= $1 AND started_ms < $2
GROUP BY plan_sha256, station, lane, started_ms / 86400000;
