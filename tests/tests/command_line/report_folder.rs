//! `--report`: all three files or none, and files of others are never touched.

use std::fs;

use halfrow_tests::not_tested::not_tested;
use halfrow_tests::program::{Folder, finish};

use crate::{refused, refused_with, small};

const FILES: [&str; 3] = ["report.html", "report.json", "report.xml"];

#[test]
fn the_folder_holds_the_report_in_three_views() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["--report", "out", "--json"])).succeeded();
    assert_eq!(folder.names("."), ["out"]);
    assert_eq!(folder.names("out"), FILES);
    let written = folder.json("out/report.json");
    assert_eq!(written, ended.json());
    assert_eq!(folder.text("out/report.json"), ended.stdout);
    assert!(folder.text("out/report.html").contains("PASS"));
    let junit = folder.text("out/report.xml");
    assert!(junit.starts_with("<?xml") && junit.contains("<testcase name="), "{junit}");
    assert!(junit.contains("failures=\"0\" errors=\"0\""), "{junit}");
}

#[test]
fn a_failure_is_reported_with_its_suspect() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["--report", "out", "--board", "mock,fault=dead-tap"]));
    assert_eq!(ended.code, Some(1));
    for name in FILES {
        assert!(folder.text(&format!("out/{name}")).contains("tap G4 stuck at 0"), "{name}");
    }
    assert!(folder.text("out/report.xml").contains("<failure"));
}

/// Without a suspect, each view still has a line for the technician and one for the designer.
#[test]
fn a_failure_without_a_suspect_says_what_to_do_at_the_bench() {
    let folder = Folder::new();
    let call = small("verify", &["--report", "out", "--board", "mock,fault=wrong-latency-claim", "--json"]);
    let ended = folder.halfrow(call);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    let report = ended.json();
    assert_eq!(report["suspects"], serde_json::json!([]));
    let (technician, remedy) = (report["technician"].as_str().unwrap(), report["remedy"].as_str().unwrap());
    assert!(technician.starts_with("Make sure that the right bitstream is loaded"), "{technician}");
    let text = folder.halfrow(small("verify", &["--board", "mock,fault=wrong-latency-claim"])).stdout;
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = folder.text("out/report.html").replace("<strong>", "").replace("</strong>", "");
    for view in [text, page, folder.text("out/report.xml")] {
        assert!(view.contains(&format!("At the bench: {technician}")), "{view}");
        assert!(view.contains(&format!("Next: {remedy}")), "{view}");
    }
}

/// A table that a narrow screen moves sideways can be reached by keyboard, has a name there, and each of its columns has one.
#[test]
fn the_report_s_wide_table_is_a_stop_of_the_keyboard_with_a_name() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["--report", "out", "--board", "mock,fault=stuck-data"]));
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    let page = folder.text("out/report.html");
    let stop = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Frames\">";
    assert!(page.contains(stop) && page.matches("class=\"scroll\"").count() == 1, "{page}");
    assert!(page.contains("<th>result</th>") && !page.contains("<th></th>"), "{page}");
}

/// Rows far above the optical centre, which read neither end of their input: judging by the output, all of it is right.
#[test]
fn a_sample_that_no_output_reads_is_not_the_crc_unit_s_fault_when_it_is_spoilt_on_its_way_in() {
    let spoilt = "mock,fault=spoilt-row,row=0,column=0,bit=5";
    let call = ["verify", "--width", "64", "--height", "4", "--radius", "36.9", "--centre-y", "24", "--json"];
    let report = Folder::new()
        .halfrow(call.into_iter().chain(["--frame", "builtin:noise", "--at-speed", "0", "--board", spoilt]))
        .json();
    assert_eq!(report["finding"]["code"], "rows-entered-changed", "{}", report["headline"]);
    let flipped = serde_json::json!({ "column": 0, "bit": 5 });
    assert_eq!(report["finding"]["parameters"]["flipped"], flipped);
    assert_eq!(report["suspects"][0]["defect"]["parameters"]["flipped"], flipped);
    assert!(report["headline"].as_str().unwrap().ends_with("in bit 5 of column 0"), "{}", report["headline"]);
}

#[test]
fn an_error_is_reported_as_an_error() {
    let folder = Folder::new();
    let ended = folder.halfrow(small("verify", &["--report", "out", "--board", "mock,fault=disconnect"]));
    assert_eq!(ended.code, Some(3));
    let junit = folder.text("out/report.xml");
    assert!(junit.contains("<error") && !junit.contains("<failure"), "{junit}");
}

#[test]
fn an_earlier_report_is_kept_unless_it_may_be_replaced() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--report", "out"])).succeeded();
    let earlier = FILES.map(|name| folder.read(&format!("out/{name}")));
    let broken = small("verify", &["--report", "out", "--board", "mock,fault=late"]);
    refused(&folder, &broken, "out exists");
    assert_eq!(folder.names("out"), FILES);
    assert!(FILES.map(|name| folder.read(&format!("out/{name}"))) == earlier);
    assert_eq!(folder.halfrow(broken.into_iter().chain(["--overwrite"])).code, Some(1));
    assert_eq!(
        (folder.names("."), folder.names("out")),
        (vec!["out".to_owned()], FILES.map(str::to_owned).to_vec())
    );
    assert!(folder.text("out/report.json").contains("\"verdict\": \"FAIL\""));
}

#[test]
fn what_is_no_report_is_never_replaced() {
    let folder = Folder::new();
    fs::create_dir(folder.path().join("photos")).unwrap();
    folder.write("photos/holiday.jpg", "precious");
    folder.write("file", "precious");
    let into = |place| small("verify", &["--overwrite", "--report", place]);
    refused(&folder, &into("photos"), "it also holds `holiday.jpg`");
    refused(&folder, &into("file"), "is not an earlier report");
    refused(&folder, &into("."), "names no folder of its own");
    assert_eq!(folder.text("photos/holiday.jpg"), "precious");
    assert_eq!(folder.names("photos"), ["holiday.jpg"]);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_board_is_opened() {
    let folder = Folder::new();
    folder.write("file", "");
    // A run on this board would end with another code.
    let board = "mock,fault=disconnect,byte=0";
    for place in ["missing/out", "file/out"] {
        refused(&folder, &small("verify", &["--report", place, "--board", board]), "folder");
    }
}

/// Nothing can be renamed to a mount point, such as a container's volume.
#[test]
fn a_mount_point_is_refused_before_the_board_is_opened_and_a_folder_inside_it_is_taken() {
    let mounted = |then: &str, more: &[&str]| {
        let folder = Folder::new();
        fs::create_dir(folder.path().join("out")).unwrap();
        let inside = format!("mount -t tmpfs none out && {then} \"$@\" && ls out/in");
        let line = format!("exec unshare --map-root-user --mount sh -c '{inside}' sh \"$@\"");
        finish(&mut folder.by_shell(&line, small("verify", more)))
    };
    let may = finish(&mut Folder::new().by_shell("unshare --map-root-user --mount true", []));
    if may.code != Some(0) {
        not_tested("a report in a mount point", "this user may mount nothing");
        return;
    }
    // A run on this board would end with another code.
    let board = "mock,fault=disconnect,byte=0";
    let refused = mounted("", &["--report", "out", "--board", board]);
    assert_eq!((refused.code, refused.stdout.as_str()), (Some(2), ""), "{}", refused.stderr);
    assert!(refused.stderr.contains("name a new folder inside it, such as out/report"), "{}", refused.stderr);
    let earlier = "\"$1\" verify --width 64 --height 4 --report out/in && mv out/in/* out && rmdir out/in &&";
    let replaced = mounted(earlier, &["--report", "out", "--overwrite", "--board", board]);
    assert_eq!(replaced.code, Some(2), "{}", replaced.stderr);
    let taken = mounted("", &["--report", "out/in"]).succeeded();
    assert!(FILES.iter().all(|name| taken.stdout.contains(name)), "{}", taken.stdout);
}

#[test]
fn a_write_protected_folder_is_left_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::set_permissions(&out, fs::Permissions::from_mode(0o500)).unwrap();
    refused(&folder, &small("verify", &["--report", "out"]), "out is write-protected and is left alone");
    refused(&folder, &small("verify", &["--report", "out", "--overwrite"]), "out is write-protected");
    assert_eq!(fs::metadata(&out).unwrap().permissions().mode() & 0o777, 0o500);
}

#[test]
fn a_place_in_a_file_system_without_files_is_refused() {
    refused(
        &Folder::new(),
        &small("verify", &["--report", "/proc/halfrow"]),
        "nothing can be written into the folder /proc;",
    );
}

#[test]
fn a_report_that_finds_no_space_leaves_none_and_is_no_pass() {
    let folder = Folder::new();
    let ended = folder.halfrow_on_a_full_disk(8, small("verify", &["--json", "--report", "out"]));
    assert_eq!((ended.code, &ended.json()["verdict"]), (Some(3), &"ERROR".into()));
    let headline = ended.json()["headline"].as_str().unwrap().to_owned();
    assert!(headline.starts_with("the report could not be written: cannot write report.json"), "{headline}");
    assert_eq!(folder.names("."), [""; 0]);
}

#[test]
fn a_fail_without_its_report_says_so_to_people_and_to_programs() {
    let folder = Folder::new();
    let call = ["--json", "--report", "out", "--board", "mock,fault=stuck-data"];
    let ended = folder.halfrow_on_a_full_disk(8, small("verify", &call));
    assert_eq!((ended.code, &ended.json()["verdict"]), (Some(1), &"FAIL".into()), "{}", ended.stderr);
    assert_eq!(ended.json()["lacks"][0]["code"], "report-lost");
    assert!(ended.stderr.contains("the report could not be written"), "{}", ended.stderr);
}

#[test]
fn a_call_that_fits_no_board_leaves_no_report() {
    let folder = Folder::new();
    let call = ["verify", "--report", "out", "--board", "mock,max-width=128"];
    refused_with(2, &folder, &call, "do not fit the board");
}

/// CI tries again after 3, and never after 2.
#[test]
fn a_disk_that_is_full_before_the_run_is_no_wrong_call() {
    let folder = Folder::new();
    for (error, code) in
        [("ENOSPC", 3), ("EDQUOT", 3), ("EIO", 3), ("EMFILE", 3), ("EACCES", 2), ("EROFS", 2)]
    {
        let line = format!("exec strace -f -qq -o /dev/null -e inject=mkdir:error={error} \"$@\"");
        let ended = finish(&mut folder.by_shell(&line, small("verify", &["--report", "out"])));
        assert_eq!((ended.code, folder.names(".").len()), (Some(code), 0), "{error}: {ended:?}");
    }
}

/// What must be found out of an earlier report before it may be replaced.
#[test]
fn an_earlier_report_that_the_system_fails_to_look_at_is_no_wrong_call() {
    let folder = Folder::new();
    let call = small("verify", &["--report", "out", "--overwrite"]);
    assert_eq!(folder.halfrow(call.clone()).code, Some(0));
    let earlier = folder.text("out/report.json");
    let (only_out, only_json) = ("-P out -e inject=openat", "-P out/report.json -e inject=openat");
    let cases = [
        (only_out, "EIO", 3),
        (only_out, "EMFILE", 3),
        (only_out, "EACCES", 2),
        (only_json, "EIO", 3),
        (only_json, "ENFILE", 3),
        (only_json, "EACCES", 2),
        ("-P out/report.json -e inject=read", "EIO", 3),
        ("-e inject=rename", "EBUSY", 2),
    ];
    for (place, error, code) in cases {
        let line = format!("exec strace -f -qq -o /dev/null {place}:error={error} \"$@\"");
        let ended = finish(&mut folder.by_shell(&line, call.clone()));
        assert_eq!(ended.code, Some(code), "{place}: {error}: {ended:?}");
        assert_eq!(folder.names("."), ["out"], "{place}: {error}: {ended:?}");
        assert!(folder.text("out/report.json") == earlier, "{place}: {error}: {ended:?}");
    }
}

/// What was written aside has a hidden name.
#[test]
fn a_run_without_descriptors_leaves_nothing_in_the_folder() {
    for descriptors in 4..14 {
        let folder = Folder::new();
        for more in [&["--report", "out"][..], &["--report", "earlier", "--overwrite"]] {
            folder.halfrow(small("verify", &["--report", "earlier", "--overwrite"])).succeeded();
            let line = format!("ulimit -n {descriptors}; exec \"$@\"");
            let ended = finish(&mut folder.by_shell(&line, small("verify", more)));
            assert_ne!(ended.code, Some(2), "{descriptors}: {ended:?}");
            let left: Vec<_> =
                folder.names(".").into_iter().filter(|name| !["out", "earlier"].contains(&&**name)).collect();
            assert_eq!(left, [""; 0], "{descriptors}: {ended:?}");
        }
    }
}

#[test]
fn an_earlier_report_that_cannot_be_removed_is_named() {
    let folder = Folder::new();
    assert_eq!(folder.halfrow(small("verify", &["--report", "out"])).code, Some(0));
    let line = "exec strace -f -qq -o /dev/null -e inject=unlinkat:error=EIO \"$@\"";
    let call = small("verify", &["--report", "out", "--overwrite"]);
    let ended = finish(&mut folder.by_shell(line, call));
    let names = folder.names(".");
    let left: Vec<_> = names.iter().filter(|name| *name != "out").collect();
    let [left] = left[..] else { panic!("{names:?}") };
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert!(ended.stderr.contains(&**left), "{left}: {ended:?}");
}
