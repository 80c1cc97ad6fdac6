-- What is counted by plan, lane and day, over whole days.
SELECT plan_sha256, station, lane, day, runs, errors, crashes, units, passed
FROM day_count
WHERE day >= $1 AND day < $2;
