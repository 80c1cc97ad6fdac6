//! How old evidence is by a clock that is wrong.

use std::process::Command;

use halfrow_station::check::check;

use super::made::{DAY_MS, End, HOUR_MS, Made, Run};
use crate::clocks::Clocks;
use crate::common::{Did, now_ms, program, untold};

/// Whatever is removed cannot be brought back. A time server may tell a wrong year, and so may whoever sets the clock.
#[test]
fn a_clock_that_is_ahead_makes_no_evidence_older() {
    for years in [0, 10] {
        let mut made = Made::new();
        for (serial, days, evidence) in [("S1", 500, "old"), ("S2", 399, "young"), ("S3", 0, "new")] {
            let started_ms = now_ms() - days * DAY_MS - HOUR_MS;
            let evidence = vec![evidence];
            made.run(&Run { started_ms, evidence, ..Run::of(serial, End::Fail(&["memory"])) });
        }
        let folder = made.folder();
        let data = made.closed();
        let place = tempfile::tempdir().unwrap();
        let clocks = Clocks::in_folder(place.path());
        clocks.ahead(years * 366 * 86_400, 0);
        let mut prune = Command::new(program());
        prune.args(["prune", "--older-than", "400", "--operator", "weber", "--data"]).arg(data.path());
        let did = Did::from(clocks.of(&mut prune).output().unwrap());
        assert!(did.said.starts_with("1 piece of evidence was removed, 3 bytes; "), "{years}: {did:?}");
        let checked = check(&folder, &mut untold).unwrap();
        assert_eq!((checked.pruned, checked.faults.len()), (1, 0), "{years}: {:?}", checked.faults);
    }
}
