-- By station: how many of it wait in front of this waiter for a board of the kind, and how many boards are free that only it
-- reaches.
WITH front AS (
  SELECT {waiter_station} AS station, count(*) AS waiting FROM waiter
  WHERE kind = $1 AND id < $2 AND until_ms >= {now_ms}
  GROUP BY 1
), own AS (
  SELECT station, count(*) AS boards FROM board
  WHERE kind = $1 AND station <> '' AND out IS NULL
    AND {free}
  GROUP BY 1
)
SELECT coalesce(front.station, own.station, ''), coalesce(waiting, 0), coalesce(boards, 0)
FROM front
FULL JOIN own ON own.station = front.station;
