SELECT attachment.run_id, attachment.name, attachment.sha256, attachment.bytes, attachment.media_type
FROM run JOIN attachment ON attachment.run_id = run.id
WHERE {of} = $1
ORDER BY attachment.run_id, attachment.name;
