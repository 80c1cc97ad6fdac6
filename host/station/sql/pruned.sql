-- Evidence that was removed since it was old, and when it last was.
SELECT subject, max(at_ms) FROM audit WHERE act = 'prune' GROUP BY subject;
