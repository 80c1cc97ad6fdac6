SELECT DISTINCT subject FROM audit WHERE act = 'prune';
