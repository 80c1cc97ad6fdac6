-- nth counts the judgements of this unit under plans of this name; an ERROR uses up no number. What checks a shift is no
-- product: its runs have the number 0, and count nowhere.
UPDATE run SET
  state = 'final', verdict = $1, exit_code = $2, cause = $3, headline = $4, ended_ms = $5, record_sha256 = $6,
  board_kind = $7, device = $8, build = $9,
  nth = CASE WHEN $10 = 1 THEN 0 ELSE (
    SELECT 1 + count(*) FROM run AS earlier
    JOIN plan AS theirs ON theirs.sha256 = earlier.plan_sha256
    JOIN plan AS ours ON ours.sha256 = run.plan_sha256
    WHERE earlier.unit_id = run.unit_id AND theirs.name = ours.name AND theirs.product = ours.product
      AND earlier.id < run.id AND earlier.nth > 0 AND earlier.verdict IN ('PASS', 'FAIL')
  ) END
WHERE id = $11 AND state = 'open' AND fence = $12;
