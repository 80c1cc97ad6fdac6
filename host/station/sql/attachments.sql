-- Each piece of evidence, and when the last run that has it ended.
SELECT attachment.sha256, max(run.ended_ms)
FROM attachment JOIN run ON run.id = attachment.run_id
GROUP BY attachment.sha256;
