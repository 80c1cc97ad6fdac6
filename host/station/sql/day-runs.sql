-- How many runs each day has, over all plans and lanes.
SELECT day, CAST(sum(runs) AS BIGINT) FROM day_count GROUP BY day;
