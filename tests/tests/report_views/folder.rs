use std::fs;
use std::path::Path;

use halfrow::link::LineErrors;
use halfrow::report::{self, ReportError, ReportFolder};
use halfrow::result::{CoverageReport, LinkReport, Report};
use halfrow::run::Finished;
use halfrow::verdict::Verdict;
use tempfile::TempDir;

use crate::made;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn write(path: &Path, overwrite: bool, report: &Report) {
    ReportFolder::prepare(path, overwrite).unwrap().commit(report, &[]).unwrap();
}

fn headline(path: &Path) -> String {
    let text = fs::read_to_string(path.join("report.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json["headline"].as_str().unwrap().to_owned()
}

#[test]
fn a_report_is_three_files_and_nothing_is_left_beside_it() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    assert_eq!(names(&path), ["report.html", "report.json", "report.xml"]);
    assert_eq!(names(station.path()), ["today"]);
}

#[test]
fn programs_find_verdict_cause_and_board_kind_at_the_top() {
    let (report, _) = made::fail();
    let json: serde_json::Value = serde_json::from_str(&report::json(&report).unwrap()).unwrap();
    assert_eq!((&json["verdict"], &json["cause"]), (&"FAIL".into(), &"different".into()));
    assert_eq!(json["board"]["kind"], "mock");
    assert_eq!(json["frames"][1]["comparison"]["first"]["found"], 209);
}

#[test]
fn an_earlier_report_is_replaced_only_on_request() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    assert!(matches!(ReportFolder::prepare(&path, false), Err(ReportError::Exists { .. })));
    write(&path, true, &made::error());
    assert_eq!(headline(&path), "no answer within 2 s");
    assert_eq!(names(station.path()), ["today"]);
}

#[test]
fn a_folder_that_is_no_report_is_never_replaced() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("thesis");
    fs::create_dir(&path).unwrap();
    for name in ["report.json", "chapter1.tex"] {
        fs::write(path.join(name), "{}").unwrap();
        let refused = ReportFolder::prepare(&path, true).unwrap_err();
        assert!(matches!(refused, ReportError::NotAReport { .. }), "{refused}");
    }
    assert_eq!(names(&path), ["chapter1.tex", "report.json"]);
    assert_eq!(names(station.path()), ["thesis"]);
}

#[test]
fn a_report_with_a_file_of_someone_else_in_it_is_left_alone() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    fs::write(path.join("notes.txt"), "the fan was off").unwrap();
    let refused = ReportFolder::prepare(&path, true).unwrap_err().to_string();
    assert!(refused.contains("it also holds `notes.txt`"), "{refused}");
    assert!(path.join("notes.txt").exists());
}

#[test]
fn a_folder_by_a_name_of_a_report_and_a_report_of_another_program_are_left_alone() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    fs::remove_file(path.join("report.html")).unwrap();
    fs::create_dir(path.join("report.html")).unwrap();
    fs::write(path.join("report.html/chapter1.tex"), "all of it").unwrap();
    let refused = ReportFolder::prepare(&path, true).unwrap_err().to_string();
    assert!(refused.contains("its `report.html` is not a file"), "{refused}");
    assert!(path.join("report.html/chapter1.tex").exists());
    fs::remove_dir_all(path.join("report.html")).unwrap();
    for other in [
        r#"{"verdict": 1, "board": 2, "findings": []}"#,
        r#"{"schema": "x-1", "command": "verify", "verdict": "PASS", "exit_code": 0, "board": {}}"#,
        r#"{"schema": 1, "command": "boards", "verdict": "PASS", "exit_code": 0, "board": {}}"#,
    ] {
        fs::write(path.join("report.json"), other).unwrap();
        let refused = ReportFolder::prepare(&path, true).unwrap_err().to_string();
        assert!(refused.contains("it holds no report.json of halfrow's"), "{refused}");
    }
}

#[test]
fn a_report_that_replaces_one_is_open_to_the_same_people() {
    use std::os::unix::fs::PermissionsExt as _;
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o7777;
    for kept in [0o700, 0o2770] {
        fs::set_permissions(&path, fs::Permissions::from_mode(kept)).unwrap();
        write(&path, true, &made::pass());
        assert_eq!(mode(), kept, "{kept:o}");
    }
}

/// `mkdir -p` or `mktemp -d` makes one before a run.
#[test]
fn an_empty_folder_is_a_place_for_a_report() {
    for overwrite in [false, true] {
        let station = TempDir::new().unwrap();
        let path = station.path().join("today");
        fs::create_dir(&path).unwrap();
        write(&path, overwrite, &made::pass());
        assert_eq!(names(&path), ["report.html", "report.json", "report.xml"]);
        assert_eq!(names(station.path()), ["today"]);
    }
    // The folder is checked again at the end.
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    fs::create_dir(&path).unwrap();
    let prepared = [false, true].map(|overwrite| ReportFolder::prepare(&path, overwrite).unwrap());
    fs::write(path.join("notes.txt"), "the fan was off").unwrap();
    let [kept, replaced] = prepared.map(|prepared| prepared.commit(&made::pass(), &[]).unwrap_err());
    assert!(matches!(kept, ReportError::Exists { .. }), "{kept}");
    let is_told = |why: &str| why == "it also holds `notes.txt`";
    assert!(matches!(&replaced, ReportError::NotAReport { why, .. } if is_told(why)), "{replaced}");
    assert_eq!(names(&path), ["notes.txt"]);
}

#[test]
fn a_file_in_the_way_is_refused() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    fs::write(&path, "a file").unwrap();
    assert!(matches!(ReportFolder::prepare(&path, true), Err(ReportError::NotAReport { .. })));
}

#[test]
fn a_missing_parent_is_found_before_the_run() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("no/such/folder");
    assert!(matches!(ReportFolder::prepare(&path, false), Err(ReportError::Prepare { .. })));
    assert!(matches!(ReportFolder::prepare(Path::new("/"), true), Err(ReportError::Name { .. })));
}

#[test]
fn a_run_that_never_ends_in_a_report_leaves_nothing_behind() {
    let station = TempDir::new().unwrap();
    drop(ReportFolder::prepare(&station.path().join("today"), false).unwrap());
    assert!(names(station.path()).is_empty());
}

#[test]
fn an_earlier_report_stays_when_the_new_one_cannot_be_put_in_its_place() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    let folder = ReportFolder::prepare(&path, true).unwrap();
    let aside = names(station.path()).into_iter().find(|name| name != "today").unwrap();
    // The folder that was to be renamed is gone, as when someone cleans up during the run.
    fs::remove_dir_all(station.path().join(aside)).unwrap();
    assert!(matches!(folder.commit(&made::error(), &[]), Err(ReportError::Write { .. })));
    assert_eq!(headline(&path), made::pass().headline());
    assert_eq!(names(station.path()), ["today"]);
}

#[test]
fn what_came_into_the_way_during_the_run_is_not_replaced() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    let folder = ReportFolder::prepare(&path, false).unwrap();
    assert!(matches!(ReportFolder::prepare(&path, false), Err(ReportError::Claimed { .. })));
    write(&path, true, &made::pass());
    assert!(matches!(folder.commit(&made::error(), &[]), Err(ReportError::Exists { .. })));
    assert_eq!(headline(&path), made::pass().headline());
    assert_eq!(names(station.path()), ["today"]);
}

#[test]
fn others_may_read_a_report_as_any_folder() {
    use std::os::unix::fs::PermissionsExt as _;
    let station = TempDir::new().unwrap();
    let (ordinary, path) = (station.path().join("ordinary"), station.path().join("today"));
    fs::create_dir(&ordinary).unwrap();
    write(&path, false, &made::pass());
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&ordinary));
}

#[test]
fn a_folder_that_has_gone_is_no_full_disk() {
    let station = TempDir::new().unwrap();
    let above = station.path().join("share");
    fs::create_dir(&above).unwrap();
    let prepared = ReportFolder::prepare(&above.join("today"), false).unwrap();
    fs::remove_dir_all(&above).unwrap();
    let error = prepared.commit(&made::pass(), &[]).unwrap_err().to_string();
    assert!(error.ends_with("check that its folder exists, is writable and has space"), "{error}");
}

/// The errors on the line did no harm: it is not they that call for a remedy.
#[test]
fn a_pass_without_its_report_keeps_nothing_of_a_pass_and_says_how_to_get_one() {
    let station = TempDir::new().unwrap();
    let above = station.path().join("share");
    fs::create_dir(&above).unwrap();
    let folder = ReportFolder::prepare(&above.join("today"), false).unwrap();
    fs::remove_dir_all(&above).unwrap();
    let passed = made::pass();
    let line_errors = LineErrors { framing: 1, ..LineErrors::default() };
    let report = Report {
        coverage: Some(CoverageReport { found: 9, faults: 10, equivalent: 1 }),
        link: LinkReport { line_errors, ..passed.link },
        ..passed
    };
    let mut finished = Finished { report, evidence: Vec::new() };
    finished.commit(folder).unwrap_err();
    let report = finished.report;
    assert_eq!(report.verdict(), Verdict::Error);
    assert_eq!((report.not_exercised.as_slice(), report.coverage), (&[][..], None));
    let remedy = report.remedy().unwrap();
    assert!(remedy.starts_with("See that its folder is there and has space"), "{remedy}");
    // A board that never answered may be at another rate.
    let silent = made::error();
    let silent = Report { link: LinkReport { line_errors, ..silent.link }, ..silent };
    assert!(silent.remedy().unwrap().contains("`baud=`"), "{:?}", silent.remedy());
}

#[test]
fn a_report_that_no_disk_kept_from_its_place_has_the_remedy_of_what_did() {
    let station = TempDir::new().unwrap();
    let path = station.path().join("today");
    write(&path, false, &made::pass());
    let folder = ReportFolder::prepare(&path, true).unwrap();
    fs::write(path.join("notes.txt"), "not of a report").unwrap();
    let mut finished = Finished { report: made::pass(), evidence: Vec::new() };
    finished.commit(folder).unwrap_err();
    let report = finished.report;
    assert!(
        report.headline().contains("is not an earlier report, and is left alone"),
        "{}",
        report.headline()
    );
    assert_eq!(report.remedy().as_deref(), Some("Give the report another name."));
}
