-- The greatest id of a run or of a change of a binding, which is in the audit. Other lines of the audit are not in order with
-- runs. These are few and have an index, unlike the rest, through which the way by the ids would lead.
SELECT max(id) FROM (SELECT max(id) AS id FROM run UNION ALL SELECT max(id || '') FROM audit WHERE act = 'rebind') AS newest;
