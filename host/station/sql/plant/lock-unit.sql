-- Runs of one unit that come from several stations at once are counted one after the other.
SELECT id FROM unit WHERE id = $1 FOR UPDATE;
