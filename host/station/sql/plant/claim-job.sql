UPDATE job SET state = 'claimed', holder = $1, fence = fence + 1, attempts = attempts + 1,
  until_ms = {now_ms} + $2
WHERE id = $3
RETURNING id, fence, plan_sha256;
