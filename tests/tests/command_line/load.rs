//! `halfrow load`, with scripts in the place of openFPGALoader.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use halfrow_tests::patience::wait_until;
use halfrow_tests::program::{Ended, Folder, Running, finish, halfrow};
use halfrow_tests::served::Served;
use serde_json::{Value, json};

/// What openFPGALoader 0.10 prints without a board, each line on the stream that it uses.
const NO_BOARD: &str = "echo 'JTAG init failed with: unable to open ftdi device'; \
                        echo 'unable to open ftdi device: -3 (device not found)' >&2; exit 1";
/// What it prints if the file is for another FPGA (its issue 373).
const OTHER_FPGA: &str = "echo 'bitstream has 0x41111043 hardware requires 0x41113043'; \
                          echo 'Error: Failed to program FPGA: std::exception' >&2; exit 1";
/// A loader that works, and notes its arguments.
const WORKS: &str = r#"printf '%s\n' "$@" >called; printf 'Loading: 40%%\rLoading: 100%%\nDone\n'"#;
/// A loader that hangs with a child, whose process id it has completely written.
const HANGS: &str = "sleep 1000 & echo $! >id; mv id child; echo started >&2; wait";

/// A loader that works, and leaves a program behind that is in no group with it and never stops printing.
const LEAVES: &str = "setsid sh -c 'echo >left; exec yes progress' & until [ -e left ]; do sleep 0.01; done";

/// A folder with a `bin/openFPGALoader` that runs `script`.
fn with_loader(script: &str) -> Folder {
    let folder = Folder::new();
    // Written by another process, so that no process started by other tests has the file open when it is run.
    let put = "mkdir bin; printf '#!/bin/sh\\n%s\\n' \"$1\" >bin/openFPGALoader; chmod +x bin/openFPGALoader";
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path()).args(["-ec", put, "sh", script]);
    finish(&mut shell).succeeded();
    folder.write("top.bit", "a bitstream");
    folder
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Lets the build scripts' own program write the record of `top.bit`.
fn recorded(folder: &Folder, board: &str, build: &str) {
    let mut record = Command::new(repository().join("fpga/boards/record"));
    record.current_dir(folder.path()).args(["top.bit", board, "xc6slx25", "fifo", build, "ISE 14.7"]);
    finish(&mut record).succeeded();
}

/// `halfrow load` in a folder whose `bin` comes first on the path.
fn command(folder: &Folder, arguments: &[&str]) -> Command {
    let mut command = folder.command(["load"].into_iter().chain(arguments.iter().copied()));
    let bin = folder.path().join("bin");
    command.env("PATH", format!("{}:/usr/bin:/bin", bin.display()));
    command
}

fn load(folder: &Folder, arguments: &[&str]) -> Ended {
    finish(&mut command(folder, arguments))
}

/// Runs a call that must end with the exit code `code` and the error code `error`; returns the error.
#[track_caller]
fn refused(folder: &Folder, arguments: &[&str], code: i32, error: &str) -> Value {
    let ended = load(folder, &[arguments, &["--json"]].concat());
    let said = ended.json();
    assert_eq!((ended.code, &said["error"]["code"]), (Some(code), &error.into()), "{said}{}", ended.stderr);
    said["error"].clone()
}

/// The code of a call whose deadline is over once the loader has ended. A busy machine may need longer than that to start a loader.
fn code_of_deadline(folder: &Folder, arguments: &[&str]) -> Value {
    let code = || load(folder, &[arguments, &["--json"]].concat()).json()["error"]["code"].clone();
    (0..20).map(|_| code()).find(|code| code != "loader-late").unwrap()
}

/// The build that the mock board reports.
fn build_of_the_mock() -> String {
    halfrow(["info", "--json"]).json()["board"]["identity"]["build"].as_str().unwrap().to_owned()
}

fn is_running(id: &str) -> bool {
    let state = fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    // A process whose parent has not waited for it yet has ended, too.
    state.rsplit(')').next().is_some_and(|rest| !rest.is_empty() && !rest.trim_start().starts_with('Z'))
}

#[test]
fn the_loader_is_called_by_its_name_of_the_board_and_the_build_is_compared() {
    let folder = with_loader(WORKS);
    let (build, served) = (build_of_the_mock(), Served::on_a_serial_port("mock"));
    let board = &served.target();
    recorded(&folder, "minispartan6plus", &build);
    let ended =
        load(&folder, &["top.bit", "--board", board, "--json", "--", "--ftdi-serial", "HR 1"]).succeeded();
    assert_eq!(folder.text("called"), "-b\nminispartan6\n--ftdi-serial\nHR 1\ntop.bit\n");
    let said = ended.json();
    assert_eq!(
        (&said["loaded"]["compared"], &said["loaded"]["onto"]),
        (&json!(true), &json!("minispartan6plus"))
    );
    assert_eq!(
        (&said["board"]["identity"]["build"], &said["loaded"]["record"]["tools"]),
        (&json!(build), &json!("ISE 14.7"))
    );
    assert!(!ended.stderr.contains("Loading"), "{}", ended.stderr);
    let told = load(&folder, &["top.bit", "--board", board]);
    assert!(told.stdout.contains(&format!("build {build}, which is the file's")), "{}", told.stdout);
    assert!(told.stderr.contains("Loading: 40%\nLoading: 100%\nDone\n"), "{}", told.stderr);
}

#[test]
fn a_board_of_another_build_is_refused() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000bad");
    let served = Served::on_a_serial_port("mock");
    let error = refused(&folder, &["top.bit", "--board", &served.target()], 6, "board-of-other-build");
    assert_eq!(error["parameters"]["board"], build_of_the_mock());
    assert_eq!(error["parameters"]["file"], "00000bad");
    assert_eq!(folder.text("called"), "-b\nulx3s\ntop.bit\n");
}

#[test]
fn a_board_that_never_answers_is_waited_for_until_the_deadline() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000001");
    let call = ["top.bit", "--board", "serial:/dev/nonesuch", "--deadline", "0.5"];
    assert_eq!(code_of_deadline(&folder, &call), "serial-port-missing");
    assert!(folder.path().join("called").exists());
}

#[test]
fn a_bitstream_without_a_record_is_loaded_with_a_warning_onto_the_board_that_is_named() {
    let folder = with_loader(WORKS);
    let error = refused(&folder, &["top.bit"], 2, "bitstream-board-not-named");
    let message = error["message"].as_str().unwrap();
    for part in ["--onto", "minispartan6plus", "ulx3s", "load another board with its own loader"] {
        assert!(message.contains(part), "{message}");
    }
    assert!(!folder.path().join("called").exists());
    let ended = load(&folder, &["top.bit", "--onto", "ulx3s", "--json"]).succeeded();
    assert!(ended.stderr.contains("warning: there is no top.bit.json beside it"), "{}", ended.stderr);
    let said = ended.json();
    assert_eq!((&said["loaded"]["record"], &said["loaded"]["compared"]), (&Value::Null, &json!(false)));
    assert_eq!(folder.text("called"), "-b\nulx3s\ntop.bit\n");
}

#[test]
fn what_contradicts_itself_is_refused_before_anything_is_loaded() {
    let folder = with_loader(WORKS);
    recorded(&folder, "minispartan6plus", "00000001");
    refused(&folder, &["top.bit", "--onto", "ulx3s"], 2, "bitstream-for-other-board");
    refused(&folder, &["top.bit", "--onto", "moon"], 2, "usage-value-wrong");
    folder.write("top.bit", "another bitstream");
    refused(&folder, &["top.bit"], 2, "bitstream-differs-from-record");
    recorded(&folder, "moon", "00000001");
    refused(&folder, &["top.bit"], 2, "bitstream-board-unknown");
    folder.write("top.bit.json", "{\"board\": \"ulx3s\"}");
    refused(&folder, &["top.bit"], 2, "bitstream-record-malformed");
    assert!(!folder.path().join("called").exists());
}

#[test]
fn a_board_that_can_never_be_greeted_is_refused_before_anything_is_loaded() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000001");
    for (board, error) in [
        ("mok", "target-kind-unknown"),
        ("tcp:nope", "tcp-address-malformed"),
        ("tcp:nope:1,rate=5", "target-option-unknown"),
        ("serial", "target-address-missing"),
        ("serial:/dev/nonesuch,baud=much", "target-option-unknown"),
        ("serial:/dev/nonesuch,board=ulx4s", "target-option-unknown"),
        ("serial:/dev/nonesuch,board=ulx3s,flow=rtscts", "target-option-contradicts-board"),
        ("usb,channel=e", "target-option-unknown"),
        ("mock,foo=1", "target-options-wrong"),
        ("replay:run.rec", "recording-answers-nothing-new"),
        ("pool:ulx3s", "bitstream-for-board-of-pool"),
        ("mock", "bitstream-for-built-in-board"),
    ] {
        refused(&folder, &["top.bit", "--board", board], 2, error);
        assert!(!folder.path().join("called").exists(), "{board}");
    }
}

/// The path that the README shows is that of a file that everybody has to build.
#[test]
fn a_bitstream_that_is_not_there_is_told_with_what_names_its_build() {
    let folder = with_loader(WORKS);
    let error = refused(&folder, &["target/ulx3s/uart-25/top.bit"], 2, "bitstream-missing");
    assert_eq!(error["parameters"], json!({ "path": "target/ulx3s/uart-25/top.bit" }));
    let message = error["message"].as_str().unwrap();
    assert!(message.contains("`halfrow boards`"), "{message}");
    assert!(halfrow(["boards"]).stdout.contains("build: fpga/boards/ulx3s/build"));
    // It is there, and cannot be read.
    refused(&folder, &["top.bit/top.bit"], 2, "input-unreadable");
}

/// A board for every call may be one that cannot be loaded.
#[test]
fn a_general_board_that_cannot_be_greeted_is_passed_over() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000001");
    folder.write("settings.toml", "board = 'replay:run.rec'\n");
    for (settings, variable) in
        [("/dev/null", Some("mock")), ("/dev/null", Some("pool:ulx3s")), ("settings.toml", None)]
    {
        let mut call = command(&folder, &["top.bit", "-v", "--json", "--settings", settings]);
        let ended = finish(call.envs(variable.map(|board| ("HALFROW_BOARD", board)))).succeeded();
        assert!(ended.stderr.contains(" is passed over: "), "{}", ended.stderr);
        assert_eq!(ended.json()["loaded"]["compared"], false);
    }
}

#[test]
fn a_loader_that_fails_is_quoted() {
    let folder = with_loader(NO_BOARD);
    recorded(&folder, "minispartan6plus", "00000001");
    let error = refused(&folder, &["top.bit"], 3, "loader-failed");
    let said = error["parameters"]["said"].as_str().unwrap();
    for line in ["JTAG init failed with: unable to open ftdi device", "device: -3 (device not found)"] {
        assert!(said.contains(line), "{said}");
    }
    assert_eq!(error["parameters"]["call"], "openFPGALoader -b minispartan6 top.bit");
}

#[test]
fn who_loads_a_file_for_another_fpga_is_told_which_it_is_for_and_by_what_else_to_load_it() {
    let folder = with_loader(OTHER_FPGA);
    let remedy = |arguments: &[&str]| {
        let error = refused(&folder, arguments, 3, "loader-failed");
        error["remedy"].as_str().unwrap().to_owned()
    };
    let unknown = remedy(&["top.bit", "--onto", "ulx3s"]);
    assert!(unknown.contains("the one that the file was built for"), "{unknown}");
    assert!(unknown.contains("`fujprog top.bit`"), "{unknown}");
    recorded(&folder, "minispartan6plus", "00000001");
    let known = remedy(&["top.bit"]);
    assert!(known.contains("the xc6slx25 that the file was built for"), "{known}");
    assert!(known.contains("`xc3sprog -c ftdi top.bit`"), "{known}");
}

#[test]
fn without_a_loader_it_is_told_how_to_get_one_and_how_to_load_by_hand() {
    let folder = Folder::new();
    folder.write("top.bit", "a bitstream");
    recorded(&folder, "ulx3s", "00000001");
    let mut command = folder.command(["load", "top.bit"]);
    let ended = finish(command.env("PATH", folder.path()));
    assert_eq!(ended.code, Some(2), "{}", ended.stderr);
    let said = ended.stderr;
    for words in ["sudo apt install openfpgaloader", "brew install openfpgaloader", "`fujprog top.bit`"] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_loader_that_hangs_is_killed_at_the_deadline_with_all_that_it_started() {
    let folder = with_loader(HANGS);
    recorded(&folder, "ulx3s", "00000001");
    // A busy machine may need longer just to start it.
    let begun = ["1", "8", "64"].into_iter().any(|deadline| {
        let error = refused(&folder, &["top.bit", "--deadline", deadline], 3, "loader-late");
        let begun = folder.path().join("child").exists();
        assert!(!begun || error["parameters"]["said"] == "started", "{error}");
        assert!(error["remedy"].as_str().unwrap().contains("plug it in"), "{error}");
        begun
    });
    assert!(begun);
    let child = folder.text("child");
    wait_until("the loader's child to end", || !is_running(child.trim()));
}

#[test]
fn a_program_that_a_loader_leaves_behind_cannot_talk_for_ever() {
    let folder = with_loader(LEAVES);
    recorded(&folder, "ulx3s", "00000001");
    load(&folder, &["top.bit"]).succeeded();
}

/// Whoever starts the program may ignore the signals of child processes.
#[test]
fn a_loader_s_end_is_known_where_signals_of_children_are_ignored() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000001");
    let wanted = command(&folder, &["top.bit"]);
    let mut deaf = Command::new("env");
    deaf.arg("--ignore-signal=CHLD").arg(wanted.get_program()).args(wanted.get_args());
    deaf.envs(wanted.get_envs().filter_map(|(name, value)| Some((name, value?)))).current_dir(folder.path());
    finish(&mut deaf).succeeded();
}

#[test]
fn a_board_that_is_silent_is_waited_for_no_longer_than_the_deadline() {
    let folder = with_loader(WORKS);
    recorded(&folder, "ulx3s", "00000001");
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("tcp:{}", silent.local_addr().unwrap());
    let call = ["top.bit", "--board", &target, "--deadline", "1"];
    assert_eq!(code_of_deadline(&folder, &call), "run-too-long");
}

#[test]
fn a_record_that_has_no_end_is_refused() {
    let folder = with_loader(WORKS);
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("top.bit.json")).unwrap();
    refused(&folder, &["top.bit", "--onto", "ulx3s"], 2, "input-is-no-regular-file");
    fs::remove_file(folder.path().join("top.bit.json")).unwrap();
    folder.write("top.bit.json", vec![b' '; (1 << 20) + 1]);
    refused(&folder, &["top.bit", "--onto", "ulx3s"], 2, "input-unreadable");
    assert!(!folder.path().join("called").exists());
}

#[test]
fn a_signal_ends_the_loader_too() {
    let folder = with_loader(HANGS);
    recorded(&folder, "ulx3s", "00000001");
    let mut running = Running::start(&mut command(&folder, &["top.bit"]));
    running.wait_for("started");
    running.send("INT");
    let ended = running.end();
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    assert!(ended.stderr.contains("may hold half of the bitstream; load it again, and "), "{}", ended.stderr);
    assert!(ended.stderr.contains("plug it in before that\n"), "{}", ended.stderr);
    let child = folder.text("child");
    wait_until("the loader's child to end", || !is_running(child.trim()));
}

/// The names of the boards in the repository.
fn folders() -> BTreeSet<String> {
    let boards = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../fpga/boards")).unwrap();
    let folders = boards.map(Result::unwrap).filter(|entry| entry.path().is_dir());
    let names = folders.map(|folder| folder.file_name().into_string().unwrap());
    names.filter(|name| !["common", "__pycache__"].contains(&name.as_str())).collect()
}

#[test]
fn the_boards_that_have_bitstreams_are_listed_with_what_to_load() {
    let listed = halfrow(["boards", "--json"]).json();
    let boards = listed["bitstreams"].as_array().unwrap();
    let names: BTreeSet<_> = boards.iter().map(|board| board["name"].as_str().unwrap().to_owned()).collect();
    assert_eq!(names, folders(), "host/cli/src/bitstreams.rs");
    let text = halfrow(["boards"]).stdout;
    for board in boards {
        assert!(text.contains(&format!("halfrow load {}", board["bitstream"].as_str().unwrap())), "{text}");
    }
    // A list of given targets says nothing about others.
    assert_eq!(halfrow(["boards", "mock", "--json"]).json()["bitstreams"], json!([]));
}

/// File names are bytes, and need not be text; the document is.
#[test]
fn a_bitstream_whose_name_is_no_text_is_loaded() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = with_loader(WORKS);
    let name = std::ffi::OsStr::from_bytes(b"caf\xe9.bit");
    fs::rename(folder.path().join("top.bit"), folder.path().join(name)).unwrap();
    let ended = finish(command(&folder, &["--json", "--onto", "ulx3s"]).arg(name)).succeeded();
    assert_eq!(ended.json()["loaded"]["file"], "caf\u{fffd}.bit");
}

#[test]
fn a_board_is_loaded_whether_or_not_stdout_takes_the_result() {
    let folder = with_loader(WORKS);
    for more in [&[][..], &["--json"]] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let mut load = command(&folder, &[&["top.bit", "--onto", "ulx3s"], more].concat());
        assert_eq!(load.stdout(full).stderr(Stdio::null()).status().unwrap().code(), Some(0), "{more:?}");
    }
}
