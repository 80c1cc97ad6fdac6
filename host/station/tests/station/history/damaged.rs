//! A database that is not whole, of which all that can be read is told, and nothing is changed.

use std::fs;

use halfrow_station::store::{Folder, Snapshot, Store};

use super::made::{End, Made, Run};
use super::put_back::killed;

/// SQLite would remove the log of a database without a page, with all runs that are only there.
#[test]
fn a_log_beside_a_database_that_is_empty_or_cut_off_stays_as_it_is() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    for (database, has_evidence, said) in [
        (&[][..], true, "no station.db that tells of them; bring back"),
        (&[], false, "no station.db that tells of them; bring back"),
        (&[b'x'; 63], true, "is damaged, or no database at all"),
        (&[b'x'; 63], false, "is damaged, or no database at all"),
    ] {
        let left = killed(&made);
        let folder = Folder::new(left.path());
        let files = || {
            ["station.db", "station.db-wal", "station.lock"].map(|name| fs::read(left.path().join(name)).ok())
        };
        fs::write(folder.database(), database).unwrap();
        if !has_evidence {
            fs::remove_dir_all(left.path().join("blobs")).unwrap();
        }
        let before = files();
        assert!(before[1].as_ref().is_some_and(|log| log.len() > 4096), "the control");
        for refused in [Snapshot::take(&folder).map(drop), Store::open(&folder).map(drop)] {
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains(said), "{refused}");
        }
        assert!(files() == before, "{} bytes, {has_evidence}", database.len());
    }
}
