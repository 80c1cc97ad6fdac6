SELECT name, kind, target, product, serial, station, out, fence,
  CASE WHEN NOT {free} THEN holder END, until_ms
FROM board
ORDER BY kind, name;
