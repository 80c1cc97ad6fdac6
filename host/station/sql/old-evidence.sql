-- No record is among it, whatever a row says.
SELECT attachment.sha256
FROM attachment JOIN run ON run.id = attachment.run_id
GROUP BY attachment.sha256
-- Where the clock was set back, a run's end is dated too early, and its id is not.
HAVING max(run.ended_ms) < $1 AND max(run.id) < $2
EXCEPT
SELECT record_sha256 FROM run
ORDER BY 1;
