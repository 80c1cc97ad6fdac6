-- The first job that a station with these plans and this equipment can judge now, on a board that is free and nobody waits for.
WITH ours AS MATERIALIZED (
  SELECT product, kind, serial, {free} AND NOT {waited_for} AS is_free, {is_well} AS is_well FROM board
  WHERE serial <> '' AND station IN ('', $1) AND out IS NULL
),
-- Of what kinds a board would do for a job by each plan. By these plans no unit that passed is judged again unasked.
kinds AS MATERIALIZED (
  SELECT job.plan_sha256, board.product, board.kind
  FROM ours AS board, unnest(string_to_array($2, ' ')) AS job (plan_sha256)
  WHERE job.plan_sha256 <> ALL (string_to_array($3, ' ')) OR {last_verdict} IS DISTINCT FROM 'PASS'
  GROUP BY job.plan_sha256, board.product, board.kind
  HAVING bool_or(board.is_free AND board.is_well) OR (bool_or(board.is_free) AND NOT bool_or(board.is_well))
)
SELECT id FROM job
WHERE state IN ('waiting', 'claimed')
  AND (state = 'waiting' OR until_ms < {now_ms})
  AND attempts < 5
  AND plan_sha256 = ANY (string_to_array($2, ' '))
  AND string_to_array(needs, ' ') <@ string_to_array($4, ' ')
  AND (
    (serial <> '' AND (product, serial) IN (SELECT product, serial FROM ours WHERE is_free))
    OR (serial = '' AND (plan_sha256, product, kind) IN (SELECT plan_sha256, product, kind FROM kinds))
  )
ORDER BY priority DESC, id
LIMIT 1
FOR UPDATE SKIP LOCKED;
