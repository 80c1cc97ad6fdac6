-- The same over a part of a day. An ERROR has a number, too, but is no judgement.
SELECT plan_sha256, station, lane, started_ms / 86400000,
  count(*),
  count(*) FILTER (WHERE verdict = 'ERROR'),
  count(*) FILTER (WHERE cause = 'crash'),
  count(*) FILTER (WHERE verdict <> 'ERROR' AND nth = 1),
  count(*) FILTER (WHERE verdict = 'PASS' AND nth = 1)
FROM run
WHERE coalesce(verdict, '') <> '' AND nth > 0 AND started_ms >= $1 AND started_ms < $2
GROUP BY plan_sha256, station, lane, started_ms / 86400000;
