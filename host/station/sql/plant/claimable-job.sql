-- The first job that a station with these plans and this equipment can judge now, on a board that is free and nobody waits for, and
-- that it can judge by the job's plan.
WITH ours AS MATERIALIZED (
  SELECT product, kind, serial, target, {free} AND NOT {waited_for} AS is_free, {is_well} AS is_well FROM board
  WHERE serial <> '' AND station IN ('', $1) AND out IS NULL
),
-- For each plan: by these plans no unit that passed is judged again unasked, and one that checks shifts by the plan never is.
fit AS MATERIALIZED (
  SELECT job.plan_sha256, board.product, board.kind, board.serial, board.is_free, board.is_well,
    (job.plan_sha256 <> ALL (string_to_array($2, ' ')) OR {last_verdict} IS DISTINCT FROM 'PASS')
      AND NOT $3::text::jsonb ? {reference} AS is_any
  FROM ours AS board, unnest(string_to_array($4, ' ')) AS job (plan_sha256)
  WHERE NOT $5::text::jsonb ? {pairing}
),
kinds AS MATERIALIZED (
  SELECT plan_sha256, product, kind FROM fit
  WHERE is_any
  GROUP BY plan_sha256, product, kind
  HAVING bool_or(is_free AND is_well) OR (bool_or(is_free) AND NOT bool_or(is_well))
)
SELECT id FROM job
WHERE state IN ('waiting', 'claimed')
  AND (state = 'waiting' OR {is_lapsed})
  AND NOT {is_spent}
  AND plan_sha256 = ANY (string_to_array($4, ' '))
  AND string_to_array(needs, ' ') <@ string_to_array($6, ' ')
  AND (
    (serial <> '' AND (plan_sha256, product, serial) IN (SELECT plan_sha256, product, serial FROM fit WHERE is_free))
    OR (serial = '' AND (plan_sha256, product, kind) IN (SELECT plan_sha256, product, kind FROM kinds))
  )
ORDER BY priority DESC, id
LIMIT 1
FOR UPDATE SKIP LOCKED;
