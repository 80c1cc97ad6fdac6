//! Boards that are unplugged and plugged in again: the run goes on where it was.

use std::time::{Duration, Instant};

use halfrow::result::{NotExercised, Report};
use halfrow::verdict::Cause;
use halfrow_tests::dice::Dice;
use halfrow_tests::parallel;
use halfrow_tests::patience::{LIMIT, come_to_an_end};
use halfrow_tests::program::{Folder, Running, command, halfrow};
use halfrow_tests::served::{Replug, Served};
use halfrow_tests::system::System;

use crate::{SMALL, ends, verify};

/// Much longer than the board is away.
const PATIENCE: Duration = LIMIT;

/// More than the bytes that end a session, after the verdict.
const LAST: usize = 100;

/// Every way in which the given board can come back.
const HOW: [fn(String) -> Replug; 3] = [|_| Replug::Powered, Replug::Switched, Replug::Reset];

/// The bytes that a whole run receives from the board, and its rows.
fn undisturbed() -> (u64, usize) {
    let served = Served::on_a_serial_port("mock");
    let report = System::TINY.judge_at(&served.target());
    assert_eq!(report.cause, Cause::Equal, "{}", report.headline());
    (report.link.bytes_in, rows(&report))
}

fn rows(report: &Report) -> usize {
    report.frames.iter().map(|frame| frame.rows).sum()
}

/// Unplugs `board` when it has sent `byte` bytes, and plugs it in again.
fn interrupted(board: &str, byte: u64, replug: Replug) -> Report {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let served = Served::unplugged_once(board, &path, byte, Some(replug));
    let target = served.target();
    come_to_an_end(move || System::TINY.judge_patiently(&target, Some(PATIENCE)))
}

/// Interrupts `count` runs in turn in every way, each after a random number of bytes, one in each part of a run.
fn goes_on_after(count: usize) {
    let (bytes, all_rows) = undisturbed();
    let mut dice = Dice::new(4);
    // One cut in every part leaves out no step of a run.
    let bytes = bytes as usize - LAST;
    let draw = |part: usize| (part * bytes + dice.below(bytes)) / count;
    let cuts: Vec<_> = (0..count).map(draw).zip(HOW.into_iter().cycle()).collect();
    let reports =
        parallel::map(&cuts, |&(byte, how)| interrupted("mock", byte as u64, how("mock".to_owned())));
    // A busy computer asks more often; if it did so only in the run before, the last of these ended before their cut.
    let is_cut = |(cut, report): &(&(usize, _), &Report)| report.link.bytes_in as usize >= cut.0 + LAST;
    let cut: Vec<_> = cuts.iter().zip(&reports).filter(is_cut).collect();
    assert!(20 * cut.len() >= 19 * count, "{} of {count}", cut.len());
    for (cut, report) in cut {
        let away: Vec<_> = report.link.reconnections.iter().map(|away| away.reason.sentence()).collect();
        assert_eq!(report.cause, Cause::Equal, "{cut:?}: {}; {away:?}", report.headline());
        assert_eq!((rows(report), away.len()), (all_rows, 1), "{cut:?}: {away:?}");
        assert!(
            report.headline().ends_with("the board went away and came back 1 time"),
            "{}",
            report.headline()
        );
    }
}

#[test]
fn a_run_goes_on_wherever_it_was_interrupted() {
    goes_on_after(60);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn a_run_goes_on_after_each_of_hundreds_of_interruptions() {
    goes_on_after(400);
}

#[test]
fn a_broken_board_is_found_although_it_was_away() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let board = "mock,fault=no-rounding";
    let served = Served::unplugged_once(board, &path, 3000, Some(Replug::Switched(board.to_owned())));
    let report = System::TINY.judge_patiently(&served.target(), Some(PATIENCE));
    assert_eq!(report.cause, Cause::Different, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
}

/// The suspects of the board at `target`, and how often it was away.
fn suspected(target: String) -> (Vec<(String, String)>, usize) {
    let system = System { height: 16, radius: 40.0, ..System::TINY };
    let report = come_to_an_end(move || system.judge_patiently(&target, Some(PATIENCE)));
    let suspects = report.suspects.iter().map(|suspect| (suspect.place(), suspect.evidence()));
    (suspects.collect(), report.link.reconnections.len())
}

/// The board is away after frames that came back right, which rule suspects out, and before the first that did not. A board that
/// was wrong before that is judged anew in another session.
#[test]
fn a_board_that_was_away_in_the_middle_is_suspected_of_the_same() {
    let faults = [
        ("kernel-word,hidden=true,bit=1", [28_000, 32_000]),
        ("row-factor,hidden=true,bit=5", [20_000, 24_000]),
    ];
    parallel::map(&faults, |(fault, cuts)| {
        let board = format!("mock,fault={fault}");
        let (undisturbed, _) = suspected(board.clone());
        assert!(!undisturbed.is_empty(), "{fault}");
        for &byte in cuts {
            let folder = Folder::new();
            let path = folder.path().join("board");
            let served = Served::unplugged_once(&board, &path, byte, Some(Replug::Powered));
            assert_eq!(suspected(served.target()), (undisturbed.clone(), 1), "{fault}, cut at {byte}");
        }
    });
}

#[test]
fn another_board_is_not_taken_for_the_one_that_went_away() {
    for (board, other) in [("mock", "mock,taps=five"), ("mock,serial=17", "mock,serial=18")] {
        let report = interrupted(board, 3000, Replug::Switched(other.to_owned()));
        assert_eq!(report.cause, Cause::Refused, "{other}: {}", report.headline());
        assert!(
            report.headline().contains("the board that came back is another one"),
            "{other}: {}",
            report.headline()
        );
    }
}

/// An ECP5 has no number: two of one build look alike.
#[test]
fn of_a_board_without_a_number_that_came_back_it_is_told_that_it_may_be_another() {
    for (board, is_known) in [("mock", false), ("mock,serial=17", true)] {
        let report = interrupted(board, 3000, Replug::Switched(board.to_owned()));
        assert_eq!(
            (report.cause, report.link.reconnections.len()),
            (Cause::Equal, 1),
            "{}",
            report.headline()
        );
        assert_eq!(!report.not_exercised.contains(&NotExercised::SameBoard {}), is_known, "{board}");
    }
    let undisturbed = System::TINY.judge_at("mock");
    assert!(!undisturbed.not_exercised.contains(&NotExercised::SameBoard {}));
}

#[test]
fn a_board_that_stays_away_is_an_error_with_the_place() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let served = Served::unplugged_once("mock", &path, 3000, None);
    let ended = verify(&served.target(), &["--reconnect=0.5"]);
    ends(&ended, 3, "the link broke while waiting for");
    ends(&ended, 3, "the board did not come back in 0.5 s");
}

#[test]
fn the_report_says_that_the_board_was_away() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    let served = Served::unplugged_once("mock", &path, 3000, Some(Replug::Powered));
    let begun = Instant::now();
    let ended = verify(&served.target(), &["--reconnect=300"]);
    let took = begun.elapsed().as_secs_f64();
    assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
    let away = &ended.json()["link"]["reconnections"];
    assert_eq!(away.as_array().unwrap().len(), 1);
    assert!(away[0]["reason"].to_string().contains("went away at"), "{away}");
    assert!((0.0..took).contains(&away[0]["seconds_away"].as_f64().unwrap()), "{away}, in a run of {took} s");
    let text = halfrow(["verify", "--board", "mock"].into_iter().chain(SMALL)).stdout;
    assert!(!text.contains("went away"), "{text}");
}

#[test]
fn waiting_for_a_board_ends_at_once_when_it_is_told_to() {
    let folder = Folder::new();
    let path = folder.path().join("board");
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let served = Served::unplugged_once("mock", &path, 3000, None);
        let target = served.target();
        let call = ["verify", "--quiet", "--reconnect=86400", "--board", &target].into_iter().chain(SMALL);
        let mut run = Running::start(&mut command(call));
        run.wait_for("waiting 86400 s for the board");
        run.send(signal);
        assert_eq!(run.end().code, Some(code));
    }
}
