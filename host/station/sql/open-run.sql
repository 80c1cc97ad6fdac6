-- The fence tells this holder of the lane from any earlier one.
INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, nth, fence, started_ms, state)
VALUES (
  $1, $2, $3, $4, $5, $6, $7, $8, 0,
  (SELECT 1 + coalesce(max(fence), 0) FROM run WHERE station = $2 AND lane = $3), $9, 'open'
)
RETURNING fence;
