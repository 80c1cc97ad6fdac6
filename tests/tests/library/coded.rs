//! The codes of the libraries' errors, for programs that tell them apart.

use std::collections::BTreeSet;
use std::fs;
use std::time::Duration;

use halfrow::ReportFolder;
use halfrow::board::{Board, BoardError, Kind, OpenOptions};
use halfrow::progress::Silent;
use halfrow::result::Problem;
use halfrow::result::codes::LISTS;
use halfrow::run::{RunOptions, verify};
use halfrow_model::{Interpolant, Phase};
use halfrow_tests::system::{System, open};
use halfrow_tests::through::Through;

use crate::words::{root, sources};

/// Where the public errors are that a program meets through `halfrow`.
const LIBRARIES: [&str; 5] =
    ["host/judge/src", "host/link/src", "host/frames/src", "host/files/src", "fpga/model/src"];

/// Errors with the code of what they hold.
const HOLDERS: [&str; 3] = ["OpenFailed", "Lack", "Problem"];

/// The name of the public type that `line` declares.
fn declared(line: &str) -> Option<&str> {
    let kind = line.strip_prefix("pub ")?;
    let name = kind.strip_prefix("enum ").or_else(|| kind.strip_prefix("struct "))?;
    name.split(|letter: char| !letter.is_alphanumeric()).next()
}

/// The type for which `line` implements `Error`.
fn implemented(line: &str) -> Option<&str> {
    line.strip_prefix("impl ")?.split_once("Error for ")?.1.split([' ', '<']).next()
}

/// Every public type of error in this source.
fn errors_of(text: &str) -> Vec<String> {
    let public: Vec<_> = text.lines().filter_map(declared).collect();
    let mut found: Vec<_> =
        text.lines().filter_map(implemented).filter(|name| public.contains(name)).collect();
    let mut lines = text.lines();
    while lines.by_ref().any(|line| line.starts_with("#[derive(") && line.contains("thiserror::Error")) {
        let begins = |line: &&str| ["pub", "enum ", "struct "].iter().any(|word| line.starts_with(word));
        found.extend(lines.by_ref().find(begins).and_then(declared));
    }
    found.into_iter().map(str::to_owned).collect()
}

#[test]
fn every_public_error_has_a_code() {
    let mut files = Vec::new();
    LIBRARIES.iter().for_each(|library| sources(&root().join(library), &mut files));
    let found: BTreeSet<_> =
        files.iter().flat_map(|file| errors_of(&fs::read_to_string(file).unwrap())).collect();
    assert!(found.len() > 50, "only {} were found", found.len());
    let coded: BTreeSet<_> = LISTS.into_iter().flatten().map(|list| list.error.to_owned()).collect();
    let uncoded: Vec<_> = found.difference(&coded).map(String::as_str).collect();
    assert_eq!(uncoded, BTreeSet::from(HOLDERS).into_iter().collect::<Vec<_>>());
}

#[test]
fn the_code_of_an_error_that_holds_another_is_that_of_the_other() {
    let _alone = crate::RUNS.lock();
    let silent = Through::boxed(open("mock").link, |link, sent, _, wait| {
        link.exchange(sent, &mut Vec::new(), wait.max(Duration::from_millis(1)))
    });
    let failed = Board::open(silent, &OpenOptions::default()).unwrap_err();
    assert_eq!(Problem::of(&failed), Problem::of(&failed.error));
    assert_eq!(Problem::of(&failed).code, "no-answer");
    assert!(matches!(failed.error, BoardError::NoAnswer { kind: Kind::Hello, .. }), "{failed}");

    let results = tempfile::tempdir().unwrap();
    let place = results.path().join("report");
    let folder = ReportFolder::prepare(&place, false).unwrap();
    let mut finished =
        verify(&System::TINIEST.plan(), open("mock"), &RunOptions::default(), &Silent).unwrap();
    fs::create_dir(&place).unwrap();
    fs::write(place.join("of somebody else"), "").unwrap();
    let lack = finished.commit(folder).unwrap_err();
    assert_eq!(lack.what.code, "report-lost");
    assert_eq!(Problem::of(&lack), *lack.what);

    assert_eq!(Problem::of(&"cubic".parse::<Interpolant>().unwrap_err()).code, "interpolant-unknown");
    assert_eq!(Problem::of(&"abcd".parse::<Phase>().unwrap_err()).code, "bayer-phase-unknown");
}
