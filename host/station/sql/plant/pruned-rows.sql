-- The run in front of which steps and measurements were last removed.
SELECT max(subject) FROM audit WHERE act = $1;
