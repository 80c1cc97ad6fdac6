//! What is removed by its age, and how old evidence is by a clock that is wrong.

use std::path::Path;
use std::process::Command;

use halfrow_station::check::check;

use super::commands::did;
use super::made::{DAY_MS, End, HOUR_MS, Made, Run, id};
use crate::clocks::Clocks;
use crate::common::{Did, now_ms, program, query, untold};

/// Evidence that is 500 and 399 days old, and some of this hour.
fn aged() -> Made {
    let mut made = Made::new();
    for (serial, days, evidence) in [("S1", 500, "old"), ("S2", 399, "young"), ("S3", 0, "new")] {
        let started_ms = now_ms() - days * DAY_MS - HOUR_MS;
        let evidence = vec![evidence];
        made.run(&Run { started_ms, evidence, ..Run::of(serial, End::Fail(&["memory"])) });
    }
    made
}

/// Runs a command on the station in `data` by a clock that is so many years ahead.
fn years_ahead(years: i64, data: &Path, arguments: &[&str]) -> Did {
    let place = tempfile::tempdir().unwrap();
    let clocks = Clocks::in_folder(place.path());
    clocks.ahead(years * 366 * 86_400, 0);
    let mut call = Command::new(program());
    call.args(arguments).args(["--operator", "weber", "--data"]).arg(data);
    clocks.of(&mut call).output().unwrap().into()
}

const PRUNE: [&str; 3] = ["prune", "--older-than", "400"];

/// Whoever makes room on a full disk finds nothing removed otherwise, and does not know why.
#[test]
fn a_prune_that_removes_nothing_says_how_the_evidence_of_earlier_runs_is_removed() {
    let data = aged().closed();
    let pruned = |more: &[&str]| {
        let prune = [&["prune", "--operator", "weber"], more].concat();
        did(&data, &prune).1
    };
    let none = "0 pieces and 0 spools that no row names were removed, 0 bytes; every record is kept";
    let how = "; with --older-than DAYS the evidence of earlier runs is removed, too\n";
    assert_eq!(pruned(&[]), format!("{none}{how}"));
    let one = "1 piece of evidence was removed, 3 bytes; ";
    assert_eq!(pruned(&["--older-than", "400"]), format!("{one}{none}\n"));
    let evidence = |serial: &str| {
        let said = did(&data, &["unit", serial]).1;
        said.lines()
            .filter(|line| line.starts_with("  evidence "))
            .map(|line| line.contains(", removed since"))
            .collect::<Vec<_>>()
    };
    assert_eq!(["S1", "S2"].map(evidence), [[true], [false]]);
    // Nothing else says later how old evidence had to be.
    let given = query(data.path(), "SELECT subject FROM audit WHERE act = 'command' ORDER BY id");
    let plain = format!("prune {}", data.path().display());
    assert_eq!(given, [plain.clone(), format!("{plain} --older-than 400")]);
}

/// Whatever is removed cannot be brought back. A time server may tell a wrong year, and so may whoever sets the clock.
#[test]
fn a_clock_that_is_ahead_makes_no_evidence_older() {
    let rebind = ["rebind", "--serial", "S3", "--device", "0000000000000007", "--reason", "repaired"];
    for (years, is_rebound) in [(0, false), (10, false), (10, true)] {
        let made = aged();
        let folder = made.folder();
        let data = made.closed();
        if is_rebound {
            let did = years_ahead(years, data.path(), &rebind);
            assert_eq!(did.code, Some(0), "{did:?}");
        }
        let did = years_ahead(years, data.path(), &PRUNE);
        let told = "1 piece of evidence was removed, 3 bytes; ";
        assert!(did.said.starts_with(told), "{years}, {is_rebound}: {did:?}");
        let checked = check(&folder, &mut untold).unwrap();
        assert_eq!((checked.pruned, checked.faults.len()), (1, 0), "{years}: {:?}", checked.faults);
    }
}

/// Nothing else tells that the clock is wrong. By their ids, all runs after such a one began after it.
#[test]
fn evidence_is_older_by_a_clock_that_is_ahead_when_the_newest_run_began_by_it_too() {
    let [one, three] = ["1 piece of evidence was removed, ", "3 pieces of evidence were removed, "];
    let ahead_ms = now_ms() + 10 * 366 * DAY_MS;
    for (years, is_followed, removed) in [(0, false, one), (10, false, three), (10, true, one)] {
        let mut made = aged();
        let ahead = Run { started_ms: ahead_ms, ..Run::of("S4", End::Fail(&["memory"])) };
        made.run(&Run { evidence: vec!["ahead"], ..ahead.clone() });
        if is_followed {
            made.run_as(id(ahead_ms + 1, 5), &Run { started_ms: now_ms(), ..ahead });
        }
        let did = years_ahead(years, made.closed().path(), &PRUNE);
        assert!(did.said.starts_with(removed), "{years}, {is_followed}: {did:?}");
    }
}
