SELECT name, kind, target, product, serial, station, out, fence,
  CASE WHEN until_ms >= CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT) THEN holder END, until_ms
FROM board
ORDER BY kind, name;
