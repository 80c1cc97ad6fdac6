//! Streams that accept nothing: full, closed, broken, or a terminal that is gone. The exit code stands, and the command's other
//! outputs are still made.

use std::fs::{File, OpenOptions};
use std::process::{Command, Stdio};

use halfrow_cli::serve::Pty;
use halfrow_tests::parallel;
use halfrow_tests::program::{Ended, Folder};

use crate::small;

/// What is wrong with a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// It accepts nothing, and says so.
    Full,
    /// It is closed.
    Closed,
    /// Its reader is gone.
    Broken,
    /// It is a terminal that is gone.
    Gone,
}

const WRONGS: [Wrong; 4] = [Wrong::Full, Wrong::Closed, Wrong::Broken, Wrong::Gone];

impl Wrong {
    /// The stream; a closed one is closed by a shell instead.
    fn stream(self) -> Stdio {
        match self {
            Self::Full => OpenOptions::new().write(true).open("/dev/full").unwrap().into(),
            Self::Closed => Stdio::null(),
            Self::Broken => {
                let (reader, writer) = std::io::pipe().unwrap();
                drop(reader);
                writer.into()
            }
            Self::Gone => {
                let terminal = Pty::open().unwrap();
                let stream = File::options().read(true).write(true).open(terminal.path()).unwrap();
                drop(terminal);
                stream.into()
            }
        }
    }

    /// Whether the result is lost: a reader that has closed its end, or a stream that was closed, wants no more.
    fn loses(self) -> bool {
        matches!(self, Self::Full | Self::Gone)
    }
}

/// Runs `halfrow` with these faults of its streams.
fn on(folder: &Folder, out: Option<Wrong>, err: Option<Wrong>, arguments: &[&str]) -> Ended {
    let closes = [(out, ">&-"), (err, "2>&-")];
    let closes = closes.iter().filter(|(wrong, _)| *wrong == Some(Wrong::Closed)).map(|(_, close)| *close);
    let line = ["exec \"$@\""].into_iter().chain(closes).collect::<Vec<_>>().join(" ");
    let mut command: Command = folder.by_shell(&line, arguments.iter().copied());
    command.stdout(out.map_or_else(Stdio::piped, Wrong::stream));
    command.stderr(err.map_or_else(Stdio::piped, Wrong::stream));
    let output = command.spawn().unwrap().wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// A call, its exit code, and its exit code if stdout does not take its only result.
type Call = (Vec<&'static str>, i32, i32);

/// What is wrong with stdout and with stderr, and a flag for the verbosity.
type Way = (Option<Wrong>, Option<Wrong>, Option<&'static str>);

/// Calls that judge or are refused: the exit code is their result.
fn judging() -> Vec<Call> {
    let broken = "mock,fault=stuck-data";
    let calls = [
        (small("verify", &[]), 0),
        (small("verify", &["--board", broken]), 1),
        (small("verify", &["--board", broken, "--json"]), 1),
        (small("verify", &["--board", "mock,fault=disconnect,byte=0"]), 3),
        (small("verify", &["--board", "mock,fault=wrong-datapath"]), 6),
        (small("verify", &["--require-hardware"]), 5),
        (vec!["verify", "--board", "tcp:localhost:1"], 3),
        (vec!["verify", "--json", "--frame", "nope.pgm"], 2),
        (vec!["verify", "--bogus"], 2),
        (vec!["info", "--json", "--board", "tcp:localhost:1"], 3),
        (vec!["lens", "--lens", "nope.yml"], 2),
        (small("tables", &["-o", "missing/t.json"]), 2),
        (vec!["correct", "nope.pgm", "--model", "-o", "r.pgm"], 2),
        (vec!["kernel", "measure", "--kernel", "nope", "--images", "x"], 2),
        (vec!["serve", "--tcp", "x"], 2),
    ];
    calls.into_iter().map(|(call, code)| (call, code, code)).collect()
}

/// Calls that write files, of which stdout only tells.
fn writing() -> Vec<Call> {
    let calls = [
        small("tables", &["-o", "t.json"]),
        small("frames", &["-o", "frames"]),
        small("correct", &["builtin:black", "--model", "-o", "q.pgm"]),
        small("correct", &["builtin:black", "--model", "--json", "-o", "q.pgm"]),
        small("lens", &["--map", "m.png"]),
        small("lens", &["--map", "m.png", "--json"]),
        vec!["paper", "fig8", "-o", "paper"],
        vec!["manual", "man"],
    ];
    calls.into_iter().map(|call| (call, 0, 0)).collect()
}

/// Calls whose only result is what they print.
fn printing() -> Vec<Call> {
    let calls = [
        small("verify", &["--list"]),
        vec!["info"],
        vec!["info", "--json"],
        vec!["link", "--seconds", "0.001"],
        vec!["boards"],
        vec!["faults"],
        vec!["faults", "--json"],
        vec!["completions", "bash"],
        vec!["--help"],
        vec!["help", "verify"],
        vec!["--version"],
        small("lens", &[]),
        small("lens", &["--json"]),
    ];
    calls.into_iter().map(|call| (call, 0, 3)).collect()
}

/// Runs every call in every way, and lists those that ended unexpectedly.
fn surprises(ways: &[Way]) -> Vec<String> {
    let calls = [judging(), writing(), printing()].concat();
    let runs: Vec<(&Call, &Way)> =
        calls.iter().flat_map(|call| ways.iter().map(move |way| (call, way))).collect();
    let run = |((call, code, lost), (out, err, verbosity)): &(&Call, &Way)| {
        let arguments: Vec<_> = verbosity.iter().chain(call).copied().collect();
        let ended = on(&Folder::new(), *out, *err, &arguments);
        let expected = if out.is_some_and(Wrong::loses) { lost } else { code };
        let is_named = expected == code || err.is_some() || ended.stderr.contains("stdout; free some space");
        let as_expected = ended.code == Some(*expected) && is_named;
        (!as_expected).then(|| format!("{arguments:?} out {out:?} err {err:?}: not {expected}, {ended:?}"))
    };
    parallel::map(&runs, run).into_iter().flatten().collect()
}

#[test]
fn stdout_that_takes_nothing_changes_no_verdict() {
    let ways: Vec<_> = WRONGS.iter().map(|&wrong| (Some(wrong), None, None)).collect();
    let surprises = surprises(&ways);
    assert!(surprises.is_empty(), "{}:\n{}", surprises.len(), surprises.join("\n"));
}

#[test]
fn stderr_that_takes_nothing_changes_nothing() {
    // With -vv every run has something to log.
    let ways: Vec<_> = WRONGS.iter().map(|&wrong| (None, Some(wrong), Some("-vv"))).collect();
    let surprises = surprises(&ways);
    assert!(surprises.is_empty(), "{}:\n{}", surprises.len(), surprises.join("\n"));
}

#[test]
fn two_streams_that_take_nothing_change_nothing_more() {
    let ways: Vec<_> =
        ["-v", "-q"].map(|verbosity| (Some(Wrong::Full), Some(Wrong::Full), Some(verbosity))).into();
    let surprises = surprises(&ways);
    assert!(surprises.is_empty(), "{}:\n{}", surprises.len(), surprises.join("\n"));
}

#[test]
fn a_failure_is_reported_and_recorded_whatever_the_streams_take() {
    for wrong in WRONGS {
        let folder = Folder::new();
        let call = ["--board", "mock,fault=stuck-data", "--report", "out", "--record", "run.rec", "-vv"];
        let ended = on(&folder, Some(wrong), Some(wrong), &small("verify", &call));
        assert_eq!(ended.code, Some(1), "{wrong:?}");
        assert_eq!(folder.names("."), ["out", "run.rec"], "{wrong:?}");
        assert!(folder.text("out/report.json").contains("\"verdict\": \"FAIL\""), "{wrong:?}");
        assert_eq!(folder.halfrow(["verify", "--board", "replay:run.rec"]).code, Some(1), "{wrong:?}");
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_not_told_of() {
    let folder = Folder::new();
    let ended = on(&folder, Some(Wrong::Broken), None, &["faults"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
}
