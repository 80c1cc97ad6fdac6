//! `--record` and `replay:FILE`: the same judgement again, without the board and without the files.

use std::fs;

use halfrow_tests::program::{Ended, Folder};
use serde_json::Value;

use crate::{refused, small};

/// Judges a board and records it; its files are removed before the recording is judged.
#[track_caller]
fn both(board: &str, arguments: &[&str], prepare: impl Fn(&Folder) -> Vec<&'static str>) -> [Ended; 2] {
    let folder = Folder::new();
    let files = prepare(&folder);
    let call = small("verify", &["--json", "--board", board, "--record", "run.rec"]);
    let first = folder.halfrow(call.into_iter().chain(arguments.iter().copied()));
    assert!(folder.names(".").contains(&"run.rec".to_owned()), "{}", first.stderr);
    for file in files {
        fs::remove_file(folder.path().join(file)).unwrap();
    }
    let again = folder.halfrow(["verify", "--json", "--board", "replay:run.rec"]);
    assert_eq!(folder.names("."), ["run.rec"]);
    [first, again]
}

/// The results of a run, without what depends on where the bytes came from.
fn findings(ended: &Ended) -> [Value; 7] {
    let said = ended.json();
    assert!(said.is_object(), "{}", ended.stderr);
    let headline = said["headline"].as_str().unwrap().split(" (").next().unwrap().to_owned();
    let what = ["verdict", "exit_code", "suspects", "frames", "latency", "tables"];
    let [verdict, exit_code, suspects, mut frames, latency, tables] = what.map(|what| said[what].clone());
    frames.as_array_mut().unwrap().iter_mut().for_each(|frame| frame["seconds"] = Value::Null);
    [verdict, exit_code, headline.into(), suspects, frames, latency, tables]
}

#[track_caller]
fn comes_out_the_same(
    code: i32,
    board: &str,
    arguments: &[&str],
    prepare: impl Fn(&Folder) -> Vec<&'static str>,
) {
    let [first, again] = both(board, arguments, prepare);
    assert_eq!((first.code, again.code), (Some(code), Some(code)), "{board}: {}", again.stdout);
    assert_eq!(findings(&first), findings(&again), "{board}");
    assert_eq!(again.json()["board"]["kind"], "replay");
}

fn no_files(_: &Folder) -> Vec<&'static str> {
    Vec::new()
}

/// Makes a frame file and a table file.
fn frame_and_tables(folder: &Folder) -> Vec<&'static str> {
    folder.halfrow(small("frames", &["--only", "street", "-o", "."])).succeeded();
    folder.halfrow(small("tables", &["--kernel", "keys", "-o", "lens.json"])).succeeded();
    vec!["street.pgm", "lens.json"]
}

#[test]
fn a_pass_passes_again() {
    comes_out_the_same(0, "mock", &[], no_files);
    comes_out_the_same(0, "mock,speed=100000,delay=0.01", &["--repeat", "2", "--kernel", "linear"], no_files);
    comes_out_the_same(0, "mock,fault=flip,rate=1e-4,seed=4", &["--seed", "99"], no_files);
}

/// f and R of a lens are two figures: R may be of another angle than 90 degrees, and R / (π / 2) is not always f to the last bit,
/// as with 0.2 mm on pixels of 2.2 µm.
#[test]
fn frames_are_seen_through_the_same_lens_again() {
    for lens in [["--focal-length", "0.2"], ["--field-of-view", "120"]] {
        let folder = Folder::new();
        let call = ["verify", "--json", "--width", "256", "--height", "64", "--at-speed", "0"];
        let first = folder.halfrow(call.into_iter().chain(lens).chain(["--record", "run.rec"]));
        let again = folder.halfrow(["verify", "--json", "--board", "replay:run.rec"]);
        assert_eq!((first.code, again.code), (Some(0), Some(0)), "{lens:?}: {}", again.stdout);
        assert_eq!(findings(&first), findings(&again), "{lens:?}");
    }
}

/// Earlier programs recorded R alone, from which f follows if R is of 90 degrees.
#[test]
fn a_recording_without_a_focal_length_is_of_the_circle_of_180_degrees() {
    let folder = Folder::new();
    let first = folder.halfrow(small("verify", &["--json", "--radius", "77.7", "--record", "run.rec"]));
    let recording = folder.read("run.rec");
    let key = b"\"lens_focal_length\":";
    let start = recording.windows(key.len()).position(|bytes| bytes == key).unwrap();
    let length = recording[start..].iter().position(|&byte| byte == b',').unwrap() + 1;
    folder.write("earlier.rec", [&recording[..start], &recording[start + length..]].concat());
    let again = folder.halfrow(["verify", "--json", "--board", "replay:earlier.rec"]);
    assert_eq!(findings(&first), findings(&again));
}

#[test]
fn a_failure_fails_again() {
    comes_out_the_same(1, "mock,fault=stuck-address", &[], no_files);
    comes_out_the_same(1, "mock,fault=no-rounding", &["--fail-fast"], no_files);
    comes_out_the_same(1, "mock,fault=row-factor", &[], no_files);
    comes_out_the_same(1, "mock,fault=lost-row", &[], no_files);
    comes_out_the_same(1, "mock,fault=late", &["--phase", "bggr", "--centre-y", "3"], no_files);
}

#[test]
fn an_error_is_one_again() {
    comes_out_the_same(3, "mock,fault=truncate,rate=0.2", &[], no_files);
    comes_out_the_same(3, "mock,speed=1000", &["--timeout", "20"], no_files);
    comes_out_the_same(3, "mock,fault=stall,packet=90,seconds=60", &[], no_files);
    comes_out_the_same(6, "mock,fault=wrong-datapath", &[], no_files);
}

#[test]
fn a_broken_link_breaks_again() {
    let [first, again] = both("mock,fault=disconnect,packet=90", &[], no_files);
    assert_eq!((first.code, again.code), (Some(3), Some(3)));
    let headline =
        |ended: &Ended| ended.json()["headline"].as_str().unwrap().split(": ").next().unwrap().to_owned();
    assert_eq!(headline(&first), headline(&again));
    assert!(headline(&first).starts_with("the link broke while waiting for row"), "{}", headline(&first));
}

#[test]
fn frames_and_tables_come_from_the_recording_when_their_files_are_gone() {
    let arguments = ["--frame", "street.pgm", "--frame", "builtin:bars", "--tables", "lens.json"];
    comes_out_the_same(0, "mock", &arguments, frame_and_tables);
    comes_out_the_same(1, "mock,fault=dead-tap,tap=6", &arguments, frame_and_tables);
    comes_out_the_same(3, "mock,fault=truncate,rate=0.2", &arguments, frame_and_tables);
}

#[test]
fn a_recording_can_be_reported_on() {
    let folder = Folder::new();
    let board = "mock,fault=dead-tap";
    assert_eq!(folder.halfrow(small("verify", &["--board", board, "--record", "run.rec"])).code, Some(1));
    let call = ["verify", "--board", "replay:run.rec", "--report", "out"];
    assert_eq!(folder.halfrow(call).code, Some(1));
    assert!(folder.text("out/report.html").contains("tap G4"));
}

#[test]
fn a_recording_is_no_hardware() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    let call = ["verify", "--json", "--board", "replay:run.rec", "--require-hardware"];
    assert_eq!(folder.halfrow(call).code, Some(5));
}

#[test]
fn a_recording_that_breaks_off_is_judged_as_far_as_it_goes() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    let whole = folder.read("run.rec");
    folder.write("half.rec", &whole[..whole.len() / 2]);
    let ended = folder.halfrow(["verify", "--json", "--board", "replay:half.rec"]);
    assert_eq!((ended.code, &ended.json()["verdict"]), (Some(3), &"ERROR".into()));
    assert!(ended.json()["headline"].as_str().unwrap().starts_with("the link broke"), "{}", ended.stdout);
    assert!(ended.stdout.contains("where the run that made it was interrupted"), "{}", ended.stdout);
}

#[test]
fn a_recording_is_no_board_for_what_it_was_never_asked() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    let soak = small("soak", &["--frames", "1", "--report", "out"]);
    let correct = small("correct", &["builtin:grey", "-o", "grey.pgm"]);
    for call in [vec!["info"], vec!["link"], vec!["serve"], soak, correct] {
        let call: Vec<_> = call.into_iter().chain(["--board", "replay:run.rec"]).collect();
        refused(&folder, &call, "a recording answers only what it was asked when it was made");
        assert!(!folder.halfrow([call[0], "--help"]).stdout.contains("replay:FILE"), "{}", call[0]);
    }
    assert!(folder.halfrow(["verify", "--help"]).stdout.contains("replay:FILE"));
}

#[test]
fn what_is_no_recording_is_refused() {
    let folder = Folder::new();
    folder.write("notes.txt", "halfrow recording of Tuesday\n");
    folder.write("head.rec", "halfrow recording 1\n{\"link\":\"x\"}\n");
    let replay = |target| ["verify", "--board", target];
    refused(&folder, &replay("replay:missing.rec"), "the recording missing.rec cannot be read");
    refused(&folder, &replay("replay:notes.txt"), "notes.txt is no recording of this version");
    fs::File::create(folder.path().join("disk.img")).unwrap().set_len(1 << 43).unwrap();
    refused(&folder, &replay("replay:disk.img"), "disk.img is no recording of this version");
    refused(&folder, &replay("replay:head.rec"), "the head of the recording head.rec is damaged");
    // It would be read until memory is full.
    refused(&folder, &replay("replay:/dev/zero"), "/dev/zero is a pipe or a device");
    refused(&folder, &replay("replay"), "write replay:FILE");
    refused(&folder, &replay("replay:"), "write replay:FILE");
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    refused(&folder, &replay("replay:run.rec,speed=1"), "the recording run.rec,speed=1 cannot be read");
}

/// A recording has no options, so no comma ends its name.
#[test]
fn a_recording_with_commas_in_its_name_is_judged_again() {
    for name in ["night, 2.rec", "a,b=1.rec"] {
        let folder = Folder::new();
        folder.halfrow(small("verify", &["--record", name])).succeeded();
        let again = folder.halfrow(["verify", "--json", "--board", &format!("replay:{name}")]).succeeded();
        assert_eq!(again.json()["board"]["target"], format!("replay:{name}"));
    }
}

/// Its frames would fill the memory before any of them is asked for.
#[test]
fn a_recording_of_more_frames_than_a_run_may_have_is_refused() {
    let folder = Folder::new();
    folder.halfrow(small("verify", &["--record", "run.rec"])).succeeded();
    let recording = String::from_utf8_lossy(&folder.read("run.rec")).into_owned();
    assert!(recording.contains("\"repeat\":1"));
    folder.write("many.rec", recording.replacen("\"repeat\":1", "\"repeat\":4294967295", 1));
    refused(&folder, &["verify", "--board", "replay:many.rec"], "frames");
}

#[test]
fn a_recording_that_is_there_is_kept() {
    let folder = Folder::new();
    folder.write("run.rec", "precious");
    refused(
        &folder,
        &small("verify", &["--record", "run.rec"]),
        "run.rec exists; allow it to be overwritten (--overwrite)",
    );
    assert_eq!(folder.text("run.rec"), "precious");
    folder.halfrow(small("verify", &["--record", "run.rec", "--overwrite"])).succeeded();
    assert!(folder.read("run.rec").starts_with(b"halfrow recording 1\n"));
    assert_eq!(folder.names("."), ["run.rec"]);
}

#[test]
fn a_recording_that_finds_no_space_is_no_pass_even_if_only_its_end_is_missing() {
    let folder = Folder::new();
    let call = |file| small("verify", &["--json", "--record", file]);
    folder.halfrow(call("whole.rec")).succeeded();
    for blocks in [0, 8, folder.read("whole.rec").len() / 512 - 1] {
        let ended = folder.halfrow_on_a_full_disk(blocks, call("run.rec"));
        let said = ended.json();
        assert_ne!(ended.code, Some(0), "{blocks} blocks");
        assert_ne!(said["verdict"], "PASS", "{blocks} blocks");
        assert!(!folder.names(".").contains(&"run.rec".to_owned()));
    }
}

/// A user without disk space for the recording still has a board to judge.
#[test]
fn a_wrong_board_is_wrong_on_a_full_disk_too() {
    let folder = Folder::new();
    let call = small("verify", &["--json", "--board", "mock,fault=stuck-data,bit=7", "--record", "run.rec"]);
    let ended = folder.halfrow_on_a_full_disk(8, call);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    assert_eq!(ended.json()["lacks"][0]["code"], "recording-lost");
    assert_eq!(ended.json()["suspects"][0]["defect"]["parameters"]["bit"], 7);
    assert!(ended.stderr.contains("the recording could not be written"), "{}", ended.stderr);
}

#[test]
fn a_recording_cannot_be_written_nowhere() {
    refused(
        &Folder::new(),
        &small("verify", &["--record", "missing/run.rec"]),
        "name another place with --record",
    );
}

/// It would answer from its beginning again.
#[test]
fn a_recording_is_not_opened_again() {
    let folder = Folder::new();
    let call = small("verify", &["--record", "run.rec", "--frame", "builtin:black", "--at-speed", "0"]);
    folder.halfrow(call).succeeded();
    let target = format!("replay:{}", folder.path().join("run.rec").display()).parse().unwrap();
    assert!(halfrow::link::open(&target).unwrap().reopen.is_none());
}
