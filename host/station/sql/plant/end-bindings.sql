-- What bound this unit or this device when a person bound anew. What a later change has ended, which came sooner, ended then already.
UPDATE binding SET to_ms = $1 WHERE id < $2 AND (unit_id = $3 OR device = $4) AND (to_ms IS NULL OR to_ms > $1);
