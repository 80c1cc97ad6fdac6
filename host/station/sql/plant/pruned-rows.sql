-- The id below which the steps and measurements of all runs were removed.
SELECT max(subject) FROM audit WHERE act = $1;
