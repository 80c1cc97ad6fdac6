-- After the plant's clock was set back, what its holder does not renew, and the place of a waiter who does not ask again, end as soon
-- as what is given now. Rows that somebody is just changing are shortened by whoever asks next.
WITH boards AS (
  UPDATE board SET until_ms = {now_ms} + $1
  WHERE name IN (SELECT name FROM board WHERE until_ms > {now_ms} + $1 FOR UPDATE SKIP LOCKED)
), jobs AS (
  UPDATE job SET until_ms = {now_ms} + $1
  WHERE id IN (SELECT id FROM job WHERE state = 'claimed' AND until_ms > {now_ms} + $1 FOR UPDATE SKIP LOCKED)
)
UPDATE waiter SET until_ms = {now_ms} + $2
WHERE id IN (SELECT id FROM waiter WHERE until_ms > {now_ms} + $2 FOR UPDATE SKIP LOCKED);
