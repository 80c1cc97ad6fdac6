//! The report for a terminal, of reports made by hand.

use halfrow::compare::{Comparison, Difference};
use halfrow::result::{BoardKind, Defect, FrameReport, MadeWith, Problem, Report, StaleFrames, Variation};
use halfrow::verdict::Cause;

use crate::made;

/// The text without colours, as a pipe gets it.
fn plain(report: &Report) -> String {
    anstream::adapter::strip_str(&halfrow_cli::text::render(report)).to_string()
}

/// The result of [`made::fail`].
const HEADLINE: &str =
    "5 of 2,076,160 samples differ, in 1 of 2 frames; the suspect is row 3's factor, bit 4";

fn last_line(text: &str) -> &str {
    text.trim_end().lines().last().unwrap()
}

#[test]
fn a_pass_ends_in_one_line_with_all_that_was_judged() {
    assert_eq!(
        last_line(&plain(&made::pass())),
        "PASS (mock board: no hardware was tested)  2 frames, 4,147,200 samples equal, latency 972 = 960 + 12 pixel \
         clocks, 1.9 s"
    );
}

#[test]
fn a_pass_says_what_was_not_exercised_before_the_verdict() {
    let text = plain(&made::pass());
    let limits =
        "\nlimits   not exercised: samples of 8 or 10 bits\n\nexplain  halfrow explain depths\n\nPASS";
    assert!(text.contains(limits), "{text}");
    let mut whole = made::pass();
    whole.not_exercised.clear();
    assert!(!plain(&whole).contains("exercised"));
}

#[test]
fn a_frame_of_its_own_says_what_it_is_for() {
    let mut report = made::pass();
    report.frames[1].variation = Some(Variation::Centre { centre2: 2176 });
    assert!(plain(&report).contains("builtin:noise, centre 1088.0"), "{}", plain(&report));
}

#[test]
fn no_pass_without_hardware_is_taken_for_one_with() {
    for kind in [BoardKind::Mock, BoardKind::Sim, BoardKind::Replay] {
        let mut report = made::pass();
        report.board.kind = kind;
        assert!(last_line(&plain(&report)).contains("no hardware was tested"), "{kind}");
    }
    let mut report = made::pass();
    report.board.kind = BoardKind::Hardware;
    assert!(
        last_line(&plain(&report)).starts_with("PASS (hardware mock, serial 000000000000002a)  2 frames")
    );
}

#[test]
fn a_fail_names_the_suspect_and_the_next_step_before_the_verdict() {
    let text = plain(&made::fail().0);
    let expected = format!(
        "
suspect  row 3's factor, bit 4 (explains 100 % of the differences)
         with the value read as 16000016 instead of 16000000, the model
         reproduces all 5 differing samples examined exactly, and changes no
         others
         At the bench: Reload the bitstream and run again. If the fault comes
         back, set the board aside: a memory block or an internal connection of
         the FPGA is faulty, which cannot be resoldered.
         Next: Check entry 3 of the row table as the datapath reads it, and the
         memory that holds it.
explain  halfrow explain samples-differ row-factor-bit-wrong

FAIL: {HEADLINE}
"
    );
    assert!(text.ends_with(&expected), "{text}");
}

#[test]
fn a_remedy_that_a_suspect_already_gives_is_not_repeated() {
    let (report, _) = made::fail();
    assert_eq!(report.remedy(), Some(report.suspects[0].designer()));
    assert_eq!(plain(&report).matches("Check entry 3 of the row table").count(), 1);
}

#[test]
fn an_error_says_what_to_do() {
    let text = plain(&made::error());
    assert!(text.ends_with("\ndo       Check cable and power.\nexplain  halfrow explain no-answer\n\nERROR: no answer within 2 s\n"), "{text}");
}

#[test]
fn every_check_has_a_line_with_its_mark_and_the_headline_is_said_once() {
    let text = plain(&made::fail().0);
    let lines = "ok       judge     this computer reproduces all 4,147,328 reference samples\n                   (scalar)\n\
                 FAIL     frames    see below\n\
                 skipped  counters  not reached\n";
    assert!(text.contains(lines), "{text}");
    assert_eq!(text.matches(HEADLINE).count(), 1);
}

#[test]
fn a_table_too_long_keeps_the_frames_that_differ() {
    let mut report = made::fail().0;
    let wrong = report.frames.remove(1);
    report.frames = (0..50).map(|number| made::equal_frame((number, "builtin:grey"))).collect();
    report.frames[40] = wrong;
    let text = plain(&report);
    assert!(text.contains("3, 0") && text.contains("alert(1)"), "{text}");
    assert!(!text.contains("builtin:grey"), "{text}");
    assert!(text.contains("… and 49 more frames\n"), "{text}");
}

#[test]
fn a_frame_that_did_not_come_back_whole_is_not_said_to_be_equal() {
    let mut report = made::error();
    report.frames = vec![FrameReport { rows: 17, ..made::equal_frame((3, "builtin:grey")) }];
    let text = plain(&report);
    let words: Vec<_> =
        text.lines().find(|line| line.contains("builtin:grey")).unwrap().split_whitespace().collect();
    assert_eq!(words, ["3", "builtin:grey", "17", "incomplete"]);
}

#[test]
fn nothing_but_the_verdict_is_wider_than_80_columns() {
    let (mut report, _) = made::fail();
    report.frames[1].name = "a/very/deep/folder/".repeat(9);
    let stale = |frame| {
        let made_with = vec![MadeWith { factors: Some(frame as u8), kernel: None }];
        StaleFrames { frame, committed: 200, made_with }
    };
    report.suspects[0].defect = Defect::StaleTables { rows: Vec::new(), frames: (0..9).map(stale).collect() };
    let difference = Difference { row: 2047, column: 2591, expected: 4095, found: 4094 };
    report.frames[1].comparison = Comparison {
        differences: 5_308_416,
        first: Some(difference),
        largest: 4095,
        ..Comparison::new(2592, 2048)
    };
    for line in plain(&report).lines().filter(|line| !line.starts_with("FAIL:")) {
        assert!(line.chars().count() <= 80, "{line}");
    }
}

/// A line never ends between a figure and its unit.
#[test]
fn no_line_ends_within_a_figure() {
    let mut report = made::pass();
    (report.link.bytes_in, report.link.bytes_out) = (629_600, 593_300);
    for letters in 0..60 {
        report.link.name = "w".repeat(letters);
        let text = plain(&report);
        let lines: Vec<_> = text.lines().collect();
        for pair in lines.windows(2) {
            let figure = pair[0].ends_with(|letter: char| letter.is_ascii_digit());
            let unit = pair[1]
                .split_whitespace()
                .next()
                .is_some_and(|word| ["kB", "x", "bits", "s"].contains(&word));
            assert!(!(figure && unit), "{text}");
        }
        assert!(text.contains("629.6 kB") && text.contains("593.3 kB"), "{text}");
    }
}

#[test]
fn what_a_board_calls_itself_cannot_drive_the_terminal() {
    let mut report = made::error();
    report.finding = Problem::new("odd", "the board says \u{1b}[2J\u{7}").into();
    assert!(halfrow_cli::text::render(&report).contains("the board says \\u{1b}[2J\\u{7}\n"));
}

#[test]
fn a_wrong_latency_says_what_was_claimed() {
    let mut report = made::pass();
    report.cause = Cause::Different;
    let latency = report.latency.as_mut().unwrap();
    (latency.most, latency.wrong_rows) = (975, 1200);
    let expected =
        "latency  972 to 975 pixel clocks instead of 972 = 960 + 12; wrong in 1,200 of\n         2,160 rows";
    let text = plain(&report);
    assert!(text.contains(expected), "{text}");
}

#[test]
fn a_soak_says_what_was_judged_and_when_it_differed() {
    let text = plain(&made::soaked());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let judged = "soak 8 h 0 min of 8 h 0 min: 1,326,976 frames in 480 bursts, 2 of which differ differs after 2 h 13 min";
    assert!(words.contains(judged), "{text}");
    assert_eq!(text.matches("\ndiffers  after ").count(), 2, "{text}");
    // A suspect that explains none of the counted differences claims no share of them.
    assert!(!text.contains("explains"), "{text}");
}
