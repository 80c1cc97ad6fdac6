SELECT id FROM origin;
