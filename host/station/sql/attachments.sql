SELECT run_id, sha256 FROM attachment;
