SELECT suspect.run_id, suspect.part, suspect.place, suspect.explained
FROM run JOIN suspect ON suspect.run_id = run.id
WHERE {of} = $1
ORDER BY suspect.run_id, suspect.rank;
