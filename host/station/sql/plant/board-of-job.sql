-- A free board that is the unit of the job, or of its kind, and that nobody waits for. One of its kind that passed already is none
-- if the plan is one of these, and one that checks shifts by the plan never is. Those that ended in an ERROR come last, and are none
-- while another one would do that did not.
WITH fit AS MATERIALIZED (
  SELECT board.name, {erred_ms} AS erred_ms, {is_well} AS is_well FROM board, job
  WHERE job.id = $1 AND board.product = job.product AND board.station IN ('', $2) AND board.out IS NULL
    AND (
      board.serial = job.serial
      OR (
        job.serial = '' AND board.kind = job.kind AND board.serial <> ''
        AND (job.plan_sha256 <> ALL (string_to_array($3, ' ')) OR {last_verdict} IS DISTINCT FROM 'PASS')
        AND NOT $4::text::jsonb ? {reference}
      )
    )
    AND NOT $5::text::jsonb ? {pairing}
)
SELECT board.name FROM board
JOIN fit ON fit.name = board.name
WHERE board.out IS NULL
  AND {free}
  AND NOT {waited_for}
  AND (fit.is_well OR NOT EXISTS (SELECT 1 FROM fit WHERE is_well))
ORDER BY fit.erred_ms NULLS FIRST, board.station = '', board.name
LIMIT 1
FOR UPDATE OF board SKIP LOCKED;
