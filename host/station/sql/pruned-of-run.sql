-- The attachments of a run that were removed because they were old. A run that ended later stored them anew.
SELECT attachment.sha256 FROM run
JOIN attachment ON attachment.run_id = run.id
JOIN audit ON audit.act = 'prune' AND audit.subject = attachment.sha256 AND audit.at_ms > run.ended_ms
WHERE run.id = $1;
