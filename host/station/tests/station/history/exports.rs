//! Exports, read by other programs.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use halfrow_station::export::{Format, run, written};
use halfrow_station::history::runs::{Filter, page};
use halfrow_station::plan::limits::{Blame, Limit, Maker, Measurement};
use halfrow_station::record::{Record, RunCause, judged};
use tempfile::TempDir;

use super::commands::did;
use super::made::{End, Made, Run};

/// A run of every kind of end, by operators whose names need care.
fn made() -> Made {
    let mut made = Made::new();
    let ends = [
        End::Pass,
        End::Fail(&["memory", "clock"]),
        End::TooLate,
        End::Error(RunCause::Link),
        End::Error(RunCause::Operator),
    ];
    for (end, hour) in ends.into_iter().zip(0..) {
        let operator =
            ["weber", "O'Neil, \"J\"", "two\nlines", "\u{1}\u{fffe}<&>", "=1+1"][hour as usize].to_owned();
        made.run(&Run { operator, ..Run::of(&format!("S{hour}"), end).at_hour(hour) });
    }
    made.run(&Run { lane: "2".to_owned(), ..Run::of("S9", End::Open) });
    made
}

/// The hashes of all records, newest first.
fn hashes(made: &Made) -> Vec<String> {
    let page = page(&made.now(), &Filter::default(), None, 100).unwrap();
    page.runs.into_iter().filter_map(|run| run.record_sha256).collect()
}

/// Exports all runs as files of this format into a folder.
fn exported(made: &Made, format: &str) -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let to = place.path().join("out");
    let (code, said, complained) = did(made, &["export", "--format", format, "--to", to.to_str().unwrap()]);
    assert_eq!((code, complained.as_str()), (0, ""));
    assert!(said.starts_with("5 runs are in "), "{said}");
    (place, to)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn a_record_is_exported_as_its_very_bytes() {
    let made = made();
    let (_kept, to) = exported(&made, "record");
    let files = files(&to);
    assert_eq!(files.len(), 5);
    for (path, hash) in files.iter().rev().zip(hashes(&made)) {
        assert_eq!(halfrow::result::sha256([fs::read(path).unwrap()]), hash);
    }
    let id = files[0].file_stem().unwrap().to_str().unwrap();
    let (code, said, _) = did(&made, &["export", id]);
    assert_eq!((code, said.as_bytes()), (0, fs::read(&files[0]).unwrap().as_slice()));
    for filter in [["--verdict", "pass"], ["--until", "2020-01-01"]] {
        let (code, _, complained) = did(&made, &[["export", id], filter].concat());
        assert_eq!(code, 2);
        assert!(complained.contains("cannot be used with"), "{complained}");
    }
}

#[test]
fn the_same_run_has_the_same_bytes_every_time() {
    let made = made();
    for format in [Format::Record, Format::Junit, Format::OpenHtf] {
        for hash in hashes(&made) {
            let once = run(&made.now(), &hash, format).unwrap();
            assert_eq!(run(&made.now(), &hash, format).unwrap(), once);
            assert!(once.ends_with(b"\n") && !once.ends_with(b"\n\n"));
        }
    }
    let [(_one, first), (_other, second)] = [exported(&made, "csv"), exported(&made, "csv")];
    assert_eq!(fs::read(first).unwrap(), fs::read(second).unwrap());
}

/// Colours are removed from other output, but a name may contain some.
#[test]
fn stdout_has_the_same_bytes_as_a_file() {
    let mut made = Made::new();
    let run = made.run(&Run { operator: "\u{1b}[31mEve\u{1b}[0m".to_owned(), ..Run::of("S1", End::Pass) });
    let place = tempfile::tempdir().unwrap();
    for format in ["record", "junit", "openhtf", "csv"] {
        let to = place.path().join(format);
        let (code, said, _) = did(&made, &["export", &run, "--format", format]);
        assert_eq!(code, 0, "{format}");
        assert_eq!(did(&made, &["export", &run, "--format", format, "--to", to.to_str().unwrap()]).0, 0);
        assert_eq!(said.as_bytes(), fs::read(to).unwrap(), "{format}");
    }
}

/// Whoever exports must learn which runs are missing, and has all others.
#[test]
fn an_export_names_the_runs_whose_records_are_damaged_and_has_all_others() {
    for format in ["csv", "record", "junit", "openhtf"] {
        let (made, place) = (made(), tempfile::tempdir().unwrap());
        let page = page(&made.now(), &Filter::default(), None, 100).unwrap();
        let runs: Vec<_> =
            page.runs.into_iter().filter_map(|run| Some((run.id, run.record_sha256?))).collect();
        fs::write(made.folder().blobs().path(&runs[1].1), "damaged").unwrap();
        fs::remove_file(made.folder().blobs().path(&runs[3].1)).unwrap();
        let to = place.path().join("out");
        let (code, said, complained) =
            did(&made, &["export", "--format", format, "--to", to.to_str().unwrap()]);
        assert!(code == 3 && said.starts_with("3 runs are in "), "{format}: {code} {said} {complained}");
        let of_csv = || fs::read_to_string(&to).unwrap();
        let of_folder = || files(&to).iter().map(|path| path.display().to_string() + "\n").collect();
        let there: String = if format == "csv" { of_csv() } else { of_folder() };
        for (place, (run, _)) in runs.iter().enumerate() {
            let is_lost = place == 1 || place == 3;
            assert_eq!((complained.contains(run), there.contains(run)), (is_lost, !is_lost), "{complained}");
        }
    }
}

#[test]
fn nothing_is_overwritten_by_an_export() {
    let made = made();
    let (_kept, to) = exported(&made, "junit");
    let (code, _, complained) = did(&made, &["export", "--format", "junit", "--to", to.to_str().unwrap()]);
    assert_eq!(code, 2, "{complained}");
    let (code, _, complained) = did(&made, &["export"]);
    assert_eq!(code, 2, "{complained}");
}

/// Of a run that is under way it would not be known yet that no evidence is kept.
#[test]
fn a_run_that_is_not_over_has_neither_record_nor_evidence() {
    let mut made = Made::new();
    let open = made.run(&Run::of("S1", End::Open));
    let to = made.folder().path().join("out");
    for run in [open.as_str(), "nothing"] {
        for call in [&["export", run][..], &["evidence", run, "--to", to.to_str().unwrap()]] {
            let (code, said, complained) = did(&made, call);
            let told = format!("no run {run} is over here");
            assert!(code == 2 && complained.contains(&told), "{call:?}: {said}{complained}");
        }
    }
}

#[test]
fn every_document_is_one_that_jenkins_takes() {
    let made = made();
    let (_kept, to) = exported(&made, "junit");
    let schema = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/tests/report_views/junit.xsd");
    let lint = |document: &str| {
        let mut lint = Command::new("xmllint")
            .args(["--noout", "--nonet", "--schema", schema, "-"])
            .stdin(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("xmllint: {error}; apt-get install libxml2-utils"));
        lint.stdin.take().unwrap().write_all(document.as_bytes()).unwrap();
        lint.wait_with_output().unwrap()
    };
    let counts = [(0, 0), (2, 0), (3, 0), (0, 2), (0, 2)];
    for (path, (failures, errors)) in files(&to).iter().zip(counts) {
        let document = fs::read_to_string(path).unwrap();
        let linted = lint(&document);
        assert!(linted.status.success(), "{}", String::from_utf8_lossy(&linted.stderr));
        assert!(!lint(&document.replace(" time=\"", " hours=\"")).status.success(), "the control");
        let suite = format!("failures=\"{failures}\" errors=\"{errors}\"");
        assert!(document.contains(&suite), "{suite} of\n{document}");
    }
}

#[test]
fn every_cell_of_the_table_is_read_back_by_python() {
    let made = made();
    let ((_one, table), (_other, records)) = (exported(&made, "csv"), exported(&made, "record"));
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/history/read_table.py");
    let read = || Command::new("python3").arg(script).arg(&table).arg(&records).output().unwrap();
    let right = read();
    assert!(right.status.success(), "{}", String::from_utf8_lossy(&right.stderr));
    assert_eq!(String::from_utf8_lossy(&right.stdout), "5 runs, 35 lines\n");
    let text = fs::read_to_string(&table).unwrap();
    fs::write(&table, text.replacen("1005.5", "1005.25", 1)).unwrap();
    assert!(!read().status.success(), "the control");
}

/// In OpenHTF's format, that is what OpenHTF itself makes of a phase with a failed measurement.
#[test]
fn a_limit_is_told_as_what_it_blames() {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    let hash = &hashes(&made)[0];
    let record = Record::parse(&made.folder().blobs().get(hash).unwrap()).unwrap();
    let outcomes = |blames, most| {
        let limit = Limit {
            measurement: Measurement::named("run.seconds").unwrap(),
            least: None,
            most: Some(most),
            blames,
        };
        let measurements = judged(Maker::Run, &[("run.seconds", Some(1.5))], &[limit]);
        let limited = Record { measurements, ..record.clone() };
        let written = |format| written(&limited, Vec::new(), format).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&written(Format::OpenHtf)).unwrap();
        let phases = json["phases"].as_array().unwrap();
        let outcome = |told: &serde_json::Value| told["outcome"].as_str().unwrap().to_owned();
        let mut told: Vec<_> = phases.iter().map(outcome).collect();
        told.push(outcome(&phases[2]["measurements"]["run.seconds"]));
        let junit = String::from_utf8(written(Format::Junit)).unwrap();
        let (_, case) = junit.split_once("name=\"run.seconds (run)\"").unwrap();
        let ends = ["failure", "error"].into_iter().find(|end| case.contains(&format!("<{end} ")));
        told.push(ends.unwrap_or("nothing").to_owned());
        told
    };
    assert_eq!(outcomes(Blame::Board, 2.0), ["PASS", "PASS", "PASS", "PASS", "nothing"]);
    assert_eq!(outcomes(Blame::Board, 1.0), ["PASS", "PASS", "FAIL", "FAIL", "failure"]);
    assert_eq!(outcomes(Blame::Station, 1.0), ["PASS", "PASS", "ERROR", "FAIL", "error"]);
    assert_eq!(outcomes(Blame::Nobody, 1.0), ["PASS", "PASS", "PASS", "PASS", "nothing"]);
}

/// With OpenHTF from PyPI, in its own virtual environment, which is made if it does not exist.
#[test]
#[ignore = "for scripts/soak"]
fn openhtf_writes_the_same_of_the_record_that_it_makes_of_ours() {
    let venv = Path::new(env!("CARGO_TARGET_TMPDIR")).join("openhtf-1.6.3");
    let python = venv.join("bin/python");
    if !python.exists() {
        assert!(Command::new("python3").args(["-m", "venv"]).arg(&venv).status().unwrap().success());
    }
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "openhtf==1.6.3"];
    assert!(Command::new(&python).args(install).status().unwrap().success());
    let made = made();
    let (_kept, to) = exported(&made, "openhtf");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/station/history/read_openhtf.py");
    let read = || Command::new(&python).arg(script).args(files(&to)).output().unwrap();
    let right = read();
    assert!(right.status.success(), "{}", String::from_utf8_lossy(&right.stderr));
    assert_eq!(String::from_utf8_lossy(&right.stdout), "5 files\n");
    let first = &files(&to)[0];
    let text = fs::read_to_string(first).unwrap();
    fs::write(first, text.replacen("x <= 1004.0", "x <= 1003.0", 1)).unwrap();
    assert!(!read().status.success(), "the control");
}

#[test]
fn evidence_is_copied_out_under_its_names() {
    let mut made = Made::new();
    made.run(&Run { evidence: vec!["in", "out"], ..Run::of("S1", End::Fail(&["memory"])) });
    let page = page(&made.now(), &Filter::default(), None, 1).unwrap();
    let (run, place) = (&page.runs[0].id, tempfile::tempdir().unwrap());
    let to = place.path().join("kept");
    let copied = |run: &str| did(&made, &["evidence", run, "--to", to.to_str().unwrap()]);
    assert_eq!(copied(run).0, 0);
    assert_eq!(
        ["in", "out"].map(|name| fs::read(to.join(format!("{name}.txt"))).unwrap()),
        [&b"in"[..], b"out"]
    );
    // A file that exists with the same content counts as copied, and another one is left alone.
    assert_eq!(copied(run).0, 0);
    fs::write(to.join("in.txt"), "mine").unwrap();
    let (code, _, complained) = copied(run);
    assert!(code == 2 && complained.contains("exists, and nothing is overwritten"), "{complained}");
    assert_eq!(fs::read(to.join("in.txt")).unwrap(), b"mine");
    fs::remove_dir_all(&to).unwrap();
    let gone = made.folder().blobs().path(&halfrow::result::sha256([b"in"]));
    fs::remove_file(gone).unwrap();
    let (code, _, complained) = copied(run);
    assert!(code == 3 && complained.contains("in.txt of the run"), "{complained}");
    assert_eq!(files(&to), [to.join("out.txt")]);
    let (code, _, complained) = copied("0");
    assert!(code == 2 && complained.contains("no run 0 is over here"), "{complained}");
}
