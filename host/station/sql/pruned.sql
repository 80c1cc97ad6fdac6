-- Evidence that was removed because it was old, and when it was last removed.
SELECT subject, max(at_ms) FROM audit WHERE act = 'prune' GROUP BY subject;
