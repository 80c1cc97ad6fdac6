-- What is counted by plan and lane, over all days.
SELECT plan_sha256, station, lane, CAST(sum(runs) AS BIGINT), CAST(sum(errors) AS BIGINT), CAST(sum(units) AS BIGINT),
  CAST(sum(passed) AS BIGINT)
FROM day_count
GROUP BY plan_sha256, station, lane;
