-- The first job that a station with these plans and this equipment can judge now, on a board that is free and nobody waits for.
WITH free AS MATERIALIZED (
  SELECT product, kind, serial FROM board
  WHERE serial <> '' AND station IN ('', $1) AND out IS NULL
    AND {free}
    AND NOT {waited_for}
),
-- For the plans by which no unit that passed is judged again unasked: what else is free.
unpassed AS MATERIALIZED (
  SELECT job.plan_sha256, board.product, board.kind
  FROM free AS board, unnest(string_to_array($2, ' ')) AS job (plan_sha256)
  WHERE {last_verdict} IS DISTINCT FROM 'PASS'
)
SELECT id FROM job
WHERE state IN ('waiting', 'claimed')
  AND (state = 'waiting' OR until_ms < {now_ms})
  AND attempts < 5
  AND plan_sha256 = ANY (string_to_array($3, ' '))
  AND string_to_array(needs, ' ') <@ string_to_array($4, ' ')
  AND (
    (serial <> '' AND (product, serial) IN (SELECT product, serial FROM free))
    OR (serial = '' AND plan_sha256 <> ALL (string_to_array($2, ' ')) AND (product, kind) IN (SELECT product, kind FROM free))
    OR (serial = '' AND (plan_sha256, product, kind) IN (SELECT plan_sha256, product, kind FROM unpassed))
  )
ORDER BY priority DESC, id
LIMIT 1
FOR UPDATE SKIP LOCKED;
