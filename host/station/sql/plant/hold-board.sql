UPDATE board SET holder = $1, fence = fence + 1, until_ms = {now_ms} + $2
WHERE name = $3
RETURNING name, target, fence, product, serial;
