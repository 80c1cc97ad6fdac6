//! Boards that are unplugged: at every packet, and in the middle of one.

use halfrow::result::CheckName;
use halfrow::result::Outcome::{Error, Skipped};
use halfrow::verdict::Cause;

use halfrow_tests::dice::Dice;
use halfrow_tests::parallel;
use halfrow_tests::patience::come_to_an_end;
use halfrow_tests::served::Served;
use halfrow_tests::system::System;

/// Judges a board that is unplugged as `options` say, which must end in an error. Returns whether it was unplugged before the run
/// ended.
fn is_unplugged(options: &str) -> bool {
    let served = Served::on_a_serial_port(&format!("mock,fault=disconnect,{options}"));
    let target = served.target();
    let report = come_to_an_end(move || System::TINIEST.judge_at(&target));
    if report.cause == Cause::Equal {
        return false;
    }
    let said = &report.headline();
    assert_eq!(report.cause, Cause::Station, "{options}: {said}");
    assert!(said.contains("the link broke while waiting for"), "{options}: {said}");
    assert!(said.contains("went away at"), "{options}: {said}");
    true
}

#[test]
fn at_every_packet_it_is_an_error_that_names_the_place() {
    for toward in ["board", "host"] {
        // Each packet that a run of frames needs, and some of the many that follow.
        let packets: Vec<u32> = (0..160).chain((160..3200).step_by(76)).collect();
        let unplugged =
            parallel::map(&packets, |packet| is_unplugged(&format!("packet={packet},toward={toward}")));
        let run = unplugged.iter().take_while(|&&unplugged| unplugged).count();
        assert!((160..packets.len()).contains(&run), "{run} packets toward the {toward}");
        assert!(!unplugged[run..].contains(&true), "{unplugged:?}");
    }
}

/// Unplugs boards after random numbers of bytes, `count` cuts in turn either way, within a whole run.
#[track_caller]
fn is_unplugged_after(count: usize) {
    let whole = System::TINIEST.judge_at(&Served::on_a_serial_port("mock").target());
    assert_eq!(whole.cause, Cause::Equal, "{}", whole.headline());
    let mut dice = Dice::new(7);
    let ends = [("board", whole.link.bytes_out), ("host", whole.link.bytes_in)];
    let cuts: Vec<_> = (0..count)
        .map(|index| {
            let (toward, bytes) = ends[index % 2];
            // The last bytes either way end the session, after the verdict.
            format!("byte={},toward={toward}", dice.below(bytes as usize - 100))
        })
        .collect();
    let unplugged = parallel::map(&cuts, |cut| is_unplugged(cut));
    let passed: Vec<_> = cuts.iter().zip(&unplugged).filter(|(_, unplugged)| !**unplugged).collect();
    assert!(passed.is_empty(), "{passed:?}");
}

#[test]
fn in_the_middle_of_packets_it_is_an_error_too() {
    is_unplugged_after(20);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn at_each_of_two_hundred_bytes_it_is_an_error() {
    is_unplugged_after(200);
}

#[test]
fn what_came_before_is_not_taken_for_a_whole_run() {
    let packets: Vec<u32> = (60..70).collect();
    let reports = parallel::map(&packets, |packet| {
        let board = format!("mock,fault=disconnect,packet={packet},toward=host");
        System::TINY.judge_at(&Served::on_a_serial_port(&board).target())
    });
    let mut partial = 0;
    for report in reports {
        assert_eq!(report.cause, Cause::Station, "{}", report.headline());
        let of = |name| report.checks.iter().find(|check| check.name == name).unwrap().outcome;
        assert_eq!(
            (of(CheckName::Frames), of(CheckName::Latency), of(CheckName::Counters)),
            (Error, Skipped, Skipped)
        );
        let torn = report.frames.iter().filter(|frame| frame.rows < System::TINY.height).count();
        let text = halfrow_cli::text::render(&report);
        assert_eq!(text.matches("incomplete").count(), torn, "{text}");
        assert!(text.contains("ERROR") && !text.contains("PASS"), "{text}");
        partial += torn;
    }
    assert!(partial > 0);
}
