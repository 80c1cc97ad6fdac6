-- A run that is over, as the station has it. The earlier judgements of its unit are counted over all stations.
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, fence, started_ms, ended_ms, verdict,
  exit_code, cause, headline, record_sha256, board_kind, device, build, state, nth)
VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17, $18, $19, 'final',
  CASE WHEN $20 = 1 THEN 0 ELSE (
    SELECT 1 + count(*) FROM run AS earlier
    JOIN plan AS theirs ON theirs.sha256 = earlier.plan_sha256
    JOIN plan AS ours ON ours.sha256 = $5
    WHERE earlier.unit_id = $4 AND theirs.name = ours.name AND theirs.product = ours.product
      AND earlier.id < $1 AND earlier.nth > 0 AND earlier.verdict IN ('PASS', 'FAIL')
  ) END
)
ON CONFLICT (id) DO NOTHING;
