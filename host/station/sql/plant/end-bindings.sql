-- Ends what bound this unit or this device before a person bound anew, even if a later change, which arrived before, has ended
-- it: it ended at the earlier time.
UPDATE binding SET to_ms = $1 WHERE id < $2 AND (unit_id = $3 OR device = $4) AND (to_ms IS NULL OR to_ms > $1);
