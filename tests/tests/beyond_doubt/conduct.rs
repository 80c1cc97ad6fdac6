//! What boards do to rows that no link can do, and what links do that is no fault of a board.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use halfrow::result::{CheckName, Finding, FlippedBit, Report, Rule};
use halfrow::run::{Plan, Vary};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_model::{BitDepth, row_signature};
use halfrow_protocol::message::{RowOut, RowPlace};
use halfrow_protocol::{Kind, Reply, samples};
use halfrow_tests::altered::{Altered, Passing, Toward, judge, judge_each};
use halfrow_tests::system::{System, failed_check, judge_by_plan};

#[track_caller]
pub(crate) fn fails(report: &Report, check: CheckName, sentence: &str) {
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(failed_check(report), Some(check), "{}", report.headline());
    assert!(report.headline().contains(sentence), "{}", report.headline());
}

#[track_caller]
pub(crate) fn passes(report: &Report) {
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// The place of a returned row.
fn place(packet: &Passing) -> Option<RowPlace> {
    match packet.reply() {
        Some(Reply::RowOut(row)) => Some(row.place),
        _ => None,
    }
}

#[test]
fn a_board_whose_replies_have_no_flag_is_understood() {
    passes(&judge_each(&System::TINY, |_, mut packet| {
        packet.header.reply = false;
        packet
    }));
    passes(&judge_each(&System::TINY, |_, mut packet| {
        packet.header.reply = true;
        packet
    }));
}

/// A row comes again just before the answer to STATUS, under the number of that request, which is far from any row's number.
#[test]
fn rows_are_no_answers_whatever_their_number() {
    let mut last: Option<Passing> = None;
    passes(&judge(&System::TINY, move |toward, packet| {
        if toward == Toward::Host && packet.is(Kind::RowOut) {
            last = Some(packet.clone());
        }
        let is_answer = toward == Toward::Host && packet.is(Kind::Status);
        match last.take_if(|row| is_answer && packet.header.sequence > row.header.sequence + 256) {
            Some(row) => {
                let again = row.with_row(|row, _| row.repeats = u16::MAX);
                vec![again.numbered(packet.header.sequence), packet]
            }
            None => vec![packet],
        }
    }));
}

/// The report on a board that sends, after row 3 of every frame, a row that `change` makes of it, with both numbered honestly.
fn with_another(change: fn(&mut RowOut<'_>, &mut Vec<u8>)) -> Report {
    let mut extra = 0;
    judge(&System::TINY, move |_, mut packet| {
        let Some(at) = place(&packet) else { return vec![packet] };
        packet.header.sequence = packet.header.sequence.wrapping_add(extra);
        if at.row != 3 {
            return vec![packet];
        }
        extra += 1;
        let another = packet.with_row(change).numbered(packet.header.sequence.wrapping_add(1));
        vec![packet, another]
    })
}

#[test]
fn a_second_copy_that_differs_is_the_board_s_fault() {
    let report = with_another(|row, packed| {
        row.repeats = 1;
        packed.iter_mut().for_each(|byte| *byte ^= 0xff);
    });
    fails(&report, CheckName::Frames, "row 3 of frame 0 came twice, and the copies differ in samples");
}

#[test]
fn a_second_copy_that_is_the_same_is_none() {
    passes(&judge(&System::TINY, |_, packet| match place(&packet) {
        Some(_) => vec![packet.clone(), packet],
        None => vec![packet],
    }));
}

#[test]
fn rows_that_nobody_sent_are_the_board_s_fault() {
    let report = with_another(|row, _| row.place.row_sequence += 1_000_000);
    fails(&report, CheckName::Frames, "which it was never given");
}

#[test]
fn a_number_of_packets_that_does_not_count_is_the_board_s_fault() {
    let report = judge_each(&System::TINY, |_, mut packet| {
        if packet.is(Kind::RowOut) {
            packet.header.sequence = 0;
        }
        packet
    });
    fails(
        &report,
        CheckName::Frames,
        "the board numbers its ROW_OUT packets wrongly: row 1 of frame 0 has the number 0",
    );
}

/// The report on a board that swaps rows 4 and 5 of every frame. With `honest`, it numbers its packets in the order in which it
/// sends them.
fn reorders(honest: bool) -> Report {
    let mut held: Option<Passing> = None;
    judge(&System::TINY, move |_, packet| match place(&packet) {
        Some(at) if at.row == 4 => {
            held = Some(packet);
            Vec::new()
        }
        Some(at) if at.row == 5 => {
            let Some(mut before) = held.take() else { return vec![packet] };
            let mut after = packet;
            if honest {
                std::mem::swap(&mut before.header.sequence, &mut after.header.sequence);
            }
            vec![after, before]
        }
        _ => vec![packet],
    })
}

#[test]
fn a_board_that_reorders_rows_is_told_from_a_link_that_does() {
    fails(
        &reorders(true),
        CheckName::Frames,
        "the board reorders rows: by the board's own packet numbers, row 4 of frame 0 left it after a later row",
    );
    passes(&reorders(false));
}

/// In the order in which they were sent, but each with the other's number.
#[test]
fn of_two_rows_with_each_other_s_numbers_the_earlier_one_left_late() {
    let report = judge_each(&System::TINY, |_, mut packet| {
        match place(&packet) {
            Some(at) if at.row == 4 => packet.header.sequence += 1,
            Some(at) if at.row == 5 => packet.header.sequence -= 1,
            _ => {}
        }
        packet
    });
    let sentence = "the board reorders rows: by the board's own packet numbers, row 4 of frame 0 left it after a later row";
    fails(&report, CheckName::Frames, sentence);
}

/// The link loses the first copy of row 4, and the second one says that it is the first. The board's numbers have room for a packet
/// where row 4 belongs.
#[test]
fn a_board_that_does_not_count_repeats_is_not_said_to_reorder_rows() {
    for (row, others) in [(4, 0), (0, 0), (4, 1)] {
        let mut lost = 0;
        let report = judge(&System::TINY, move |_, packet| match place(&packet) {
            Some(at) if (row..=row + others).contains(&at.row) && lost <= others => {
                lost += 1;
                Vec::new()
            }
            Some(_) => vec![packet.with_row(|row, _| row.repeats = 0)],
            _ => vec![packet],
        });
        let sentence = format!("the board sent row {row} of frame 0 twice with `repeats` = 0");
        fails(&report, CheckName::Frames, &sentence);
    }
}

#[test]
fn gaps_are_compared_with_their_seed() {
    let report = judge_each(&System::TINY, |_, packet| match place(&packet) {
        Some(at) if at.row == 5 => packet.with_row(|row, _| row.pauses += 1),
        _ => packet,
    });
    fails(&report, CheckName::Counters, "the board counts 1 board clock of gaps");
}

/// The report on a board after `change` was made to each row that `is_meant`.
fn with_rows(is_meant: fn(&RowPlace) -> bool, change: fn(&mut RowOut<'_>)) -> Report {
    judge_each(&System::TINY, move |_, packet| match place(&packet) {
        Some(at) if is_meant(&at) => packet.with_row(|row, _| change(row)),
        _ => packet,
    })
}

#[test]
fn rows_that_say_that_they_were_sent_before_are_compared_with_the_board_s_count() {
    let report = with_rows(|at| at.frame == 2 && at.row == 5, |row| row.repeats = 7);
    fails(&report, CheckName::Counters, "0 rows sent again; the right number is 7");
}

/// The row has its own number, but another place.
#[test]
fn a_row_that_comes_under_another_place_is_the_board_s_fault() {
    let changes: [fn(&mut RowOut<'_>); 4] = [
        |row| row.place.frame += 1,
        |row| row.place.row += 1,
        |row| row.place.width += 2,
        |row| row.place.last = true,
    ];
    for change in changes {
        let report = with_rows(|at| at.frame == 2 && at.row == 5, change);
        fails(&report, CheckName::Frames, "with a place that was never sent");
    }
}

#[test]
fn what_entered_is_looked_at_wherever_a_board_is_to_tell_it() {
    let report = with_rows(|_| true, |row| row.entered = None);
    fails(
        &report,
        CheckName::Frames,
        "the board's CRC of the samples that entered the core differs from that of the samples that were sent",
    );
    // Only after the frames of the plan, where rules are tried.
    let report = with_rows(|at| at.frame > 1000, |row| row.entered = row.entered.map(|crc| crc ^ 1));
    assert_eq!((report.verdict(), failed_check(&report)), (Verdict::Fail, Some(CheckName::Rules)));
}

/// For each row it looks as if a bit were flipped in the first column, but every output computed from that column is right.
#[test]
fn a_crc_unit_that_begins_with_a_wrong_bit_is_no_flipped_bit() {
    fn change(row: &mut RowOut<'_>) {
        let mut sent = vec![0; usize::from(row.place.width)];
        let right = row_signature(&sent);
        sent[0] = 1 << 3;
        row.entered = row.entered.map(|crc| crc ^ right ^ row_signature(&sent));
    }
    let every = with_rows(|_| true, change);
    assert!(matches!(every.finding, Finding::EntryMiscounted { row: 0, .. }), "{:?}", every.finding);
    let one = with_rows(|at| at.row == 2, change);
    let bit = Some(FlippedBit { column: 0, bit: 3 });
    assert!(
        matches!(one.finding, Finding::RowsEnteredChanged { row: 2, flipped, .. } if flipped == bit),
        "{:?}",
        one.finding
    );
}

/// The comparisons hold for the Verilog as for the mock, over sound links and poor ones.
#[cfg(feature = "sim")]
#[test]
fn the_verilog_counts_what_the_host_sees() {
    for board in ["sim", "sim,fault=lose,rate=0.02,seed=3", "sim,fault=stall,every=12000,seconds=3"] {
        passes(&System::TINY.judge_at(board));
    }
}

/// Each answer to a read-back in turn is wrong once, including those between frames with other settings, and the last one.
#[test]
fn a_board_that_reads_back_wrong_once_fails_whenever_that_is() {
    let plan = System { height: 16, ..System::TINY }.plan().varying(Vary { centre: true, depth: true });
    let judged = |which: usize| {
        let answers = Arc::new(AtomicUsize::new(0));
        let seen = Arc::clone(&answers);
        let alter = move |toward, packet: Passing| match packet.reply() {
            Some(Reply::TableCrc(crc))
                if toward == Toward::Host && seen.fetch_add(1, Ordering::Relaxed) == which =>
            {
                vec![packet.saying(&Reply::TableCrc(crc ^ 1))]
            }
            _ => vec![packet],
        };
        let report = judge_by_plan(&plan, Altered::new(&Options::default(), alter).candidate());
        (report, answers.load(Ordering::Relaxed))
    };
    let (sound, answers) = judged(usize::MAX);
    passes(&sound);
    assert!(answers > 10, "{answers}");
    for which in 0..answers {
        let (report, _) = judged(which);
        assert_eq!(report.verdict(), Verdict::Fail, "answer {which} of {answers}: {}", report.headline());
    }
}

/// The board's own answers to RESET show the wrong window, once a row does not come back that the host could not send.
#[test]
fn a_window_that_stands_still_ends_the_run() {
    let system = System { height: 16, ..System::TINY };
    for most in [0, 15, 16, 17, 32, 48] {
        let report = judge_each(&system, move |toward, mut packet| {
            if toward == Toward::Host {
                packet.header.window = packet.header.window.min(most);
            }
            packet
        });
        let is_told = matches!(report.finding, Finding::RuleBroken { rule: Rule::Window, .. });
        assert!(report.verdict() == Verdict::Fail && is_told, "{most}: {}", report.headline());
    }
}

/// Most end with an error, because the host then sends rows for which the board has no room.
#[test]
fn a_window_beyond_every_row_makes_no_run_fail() {
    let (changed, mut errors) = (Arc::new(AtomicUsize::new(0)), 0);
    let runs = (0..400).step_by(8);
    for which in runs.clone() {
        let (mut seen, changes) = (0, Arc::clone(&changed));
        let report = judge_each(&System::TINY, move |toward, mut packet| {
            seen += usize::from(toward == Toward::Host);
            if toward == Toward::Host && seen == which + 1 {
                packet.header.window = u32::MAX;
                changes.fetch_add(1, Ordering::Relaxed);
            }
            packet
        });
        assert_ne!(report.verdict(), Verdict::Fail, "packet {which}: {}", report.headline());
        errors += usize::from(report.verdict() == Verdict::Error);
    }
    assert_eq!(changed.load(Ordering::Relaxed), runs.len());
    assert!(2 * errors > runs.len(), "{errors} of {}", runs.len());
}

/// Only STATUS tells whether the link delivered a request twice.
#[test]
fn what_is_wrong_is_no_fail_while_the_board_does_not_tell_what_came_to_it() {
    // With a wrong row, and no answers to STATUS after the first `until`.
    let judged = |until: usize| {
        let answers = Arc::new(AtomicUsize::new(0));
        let seen = Arc::clone(&answers);
        let report = judge(&System::TINY, move |toward, packet| {
            if toward == Toward::Host && packet.is(Kind::Status) {
                let is_answered = seen.fetch_add(1, Ordering::Relaxed) < until;
                return if is_answered { vec![packet] } else { Vec::new() };
            }
            match place(&packet) {
                Some(place) if toward == Toward::Host && place.row_sequence == 5 => {
                    vec![packet.with_row(|_, packed| packed[0] ^= 1)]
                }
                _ => vec![packet],
            }
        });
        (report, answers.load(Ordering::Relaxed))
    };
    let (report, answers) = judged(usize::MAX);
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    let (report, _) = judged(answers - 1);
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

#[test]
fn samples_that_the_depth_cannot_hold_are_kept_and_explained() {
    let plan = Plan { fail_fast: false, ..System { height: 16, ..System::TINY }.plan() };
    let centre2 = plan.tables.geometry().centre2();
    let tables = plan.tables.with_settings(BitDepth::Eight, centre2).unwrap();
    let alter = move |_, packet: Passing| match place(&packet) {
        Some(place) => {
            vec![packet.with_row(|_, packed| {
                let mut row = vec![0; place.width.into()];
                samples::unpack(packed, &mut row);
                row.iter_mut().for_each(|sample| *sample |= 1 << 9);
                packed.clear();
                samples::pack(&row, packed);
            })]
        }
        None => vec![packet],
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let report = judge_by_plan(&Plan { tables, ..plan }, candidate);
    fails(&report, CheckName::Frames, "differ");
    assert!(report.evidence.kept > 0);
    assert!(!report.suspects.is_empty(), "{}", report.headline());
}
