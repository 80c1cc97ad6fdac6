DELETE FROM station WHERE name = $1;
