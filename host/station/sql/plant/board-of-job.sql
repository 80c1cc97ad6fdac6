-- A free board that is the unit of the job, or of its kind, and that nobody waits for. One of its kind that passed already is none
-- if the plan is one of these.
SELECT board.name FROM board, job
WHERE job.id = $1 AND board.product = job.product AND board.station IN ('', $2) AND board.out IS NULL
  AND (
    board.serial = job.serial
    OR (
      job.serial = '' AND board.kind = job.kind AND board.serial <> ''
      AND (job.plan_sha256 <> ALL (string_to_array($3, ' ')) OR {last_verdict} IS DISTINCT FROM 'PASS')
    )
  )
  AND {free}
  AND NOT {waited_for}
ORDER BY board.station = '', board.name
LIMIT 1
FOR UPDATE OF board SKIP LOCKED;
