//! What a board must refuse, keep and end: a board that does not fails, wherever that is, and a sound one never does.

use halfrow::result::{Answer, Check, CheckName, Finding, NotExercised, Outcome, Report, RowPart, Rule};
use halfrow::run::{AtSpeed, Part, Plan, Selection};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{BurstState, Records, Refusal, RowOut, Status, TrappedRow};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan, open};

use super::by_the_rules::{altering, broken, plan, refusal, said_by};

/// The number of the frame in which rows are sent out of order.
const FRAME: u16 = 0x1234;

fn check(report: &Report) -> &Check {
    report.checks.iter().find(|check| check.name == CheckName::Rules).unwrap()
}

/// The report on a board after `alter` changed everything that it sends; none drops a packet.
fn saying(alter: impl FnMut(Passing) -> Option<Passing> + Send + 'static) -> Report {
    said_by(&Options::default(), alter)
}

#[test]
fn builds_of_every_kind_keep_the_rules() {
    let small = "max-height=1,max-width=64,records=2,table-banks=1,row-banks-in=2,row-banks-out=2,taps=five";
    let others = "row-banks-in=5,row-banks-out=7,records=64,least-blanking=30,latency=9,ring=4096";
    for options in [
        "",
        "table-banks=1",
        "bursts=no,entered=no",
        "bursts=untrapped",
        "records=226",
        "records=300",
        "records=1024",
        "records=1025",
        others,
    ] {
        let report = judge_by_plan(&plan(), open(format!("mock,{options}").trim_end_matches(',')));
        assert_eq!(report.verdict(), Verdict::Pass, "{options}: {}", report.headline());
        let Finding::RulesKept { requests } = check(&report).finding else {
            panic!("{}", check(&report).detail())
        };
        assert!(requests > 300, "{options}: {requests}");
        // A burst fills no more than 1024 (docs/running.md).
        let further = NotExercised::FurtherRecords { filled: 1024 };
        assert_eq!(report.not_exercised.contains(&further), options == "records=1025", "{options}");
    }
    for (height, options) in [(1, small), (2, "max-height=2"), (3, "max-height=3")] {
        let low = Plan { selection: plan().selection, ..System { height, ..System::TINY }.plan() };
        let report = judge_by_plan(&low, open(&format!("mock,{options}")));
        assert_eq!(report.verdict(), Verdict::Pass, "{options}: {}", report.headline());
    }
}

/// There row factors have no room for a right one in front of a wrong one, and a grid has.
#[test]
fn entries_of_a_grid_that_are_written_in_front_of_a_wrong_one_fail_on_a_board_of_one_row() {
    let low = Plan { selection: plan().selection, ..System::TINIEST.plan() };
    let report = judge_by_plan(&low, open("mock,max-height=1,fault=unkept-rule"));
    assert_eq!(broken(&report).0, Rule::Entry);
}

/// Pauses of a burst are no fault, and only one of a record's flags has a meaning.
#[test]
fn what_a_record_may_say_is_not_looked_at() {
    let report = saying(|mut packet| {
        if packet.is(Kind::Records) && refusal(&packet).is_none() {
            for record in packet.payload[10..].as_chunks_mut::<18>().0 {
                (record[14], record[17]) = (3, record[17] | 0x80);
            }
        }
        Some(packet)
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

#[test]
fn a_refusal_for_another_reason_or_with_another_detail_fails() {
    for detail in [false, true] {
        let report = saying(move |packet| {
            let Some(refusal) = refusal(&packet).filter(|refusal| refusal.kind == Kind::Configure.code())
            else {
                return Some(packet);
            };
            let code = if detail { refusal.code } else { halfrow::board::RefusalCode::Busy };
            let other = Refusal { code, detail: refusal.detail ^ u16::from(detail), ..refusal };
            Some(packet.saying(&Reply::Refusal(other)))
        });
        let (rule, ..) = broken(&report);
        // A configuration that is cut short is refused first, and without a detail.
        assert!([Rule::Payload, Rule::Configuration].contains(&rule), "{rule:?}");
    }
}

/// What a link may do to a single packet.
const UPSETS: [&str; 3] = ["duplicate", "reorder", "drop"];
#[test]
fn whatever_a_link_does_to_one_packet_a_sound_board_passes() {
    upset_packets(499);
}

#[test]
#[ignore = "minutes long; scripts/soak runs it"]
fn whatever_a_link_does_to_any_packet_a_sound_board_passes() {
    upset_packets(1);
}

/// Upsets every `step`-th packet either way, each in a run of its own.
fn upset_packets(step: usize) {
    let whole = judge_by_plan(&plan(), open("mock")).link;
    let packets = whole.packets_out.max(whole.packets_in);
    for upset in UPSETS {
        for toward in ["board", "host"] {
            for packet in (1..packets).step_by(step) {
                let board = format!("mock,fault={upset},packet={packet},toward={toward}");
                let report = judge_by_plan(&plan(), open(&board));
                assert_eq!(report.verdict(), Verdict::Pass, "{board}: {}", report.headline());
            }
        }
    }
}

/// The missing answer, according to the report.
fn unsaid(report: &Report) -> (Rule, &Answer) {
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let Finding::WrongOverDoubtfulLink { found, .. } = &report.finding else {
        panic!("{}", report.headline())
    };
    match &**found {
        Finding::RuleBroken { rule, right, found: Answer::Nothing {}, .. } => (*rule, right),
        other => panic!("{}", other.sentence()),
    }
}

/// The link may lose the same packet each time, but the report says what was asked.
#[test]
fn a_board_that_says_nothing_where_it_must_refuse_is_told_of() {
    for kind in [Kind::RowIn, Kind::TableCrc, Kind::TableRead, Kind::Commit, Kind::Records] {
        let report = saying(move |packet| {
            let is_lost = refusal(&packet).is_some_and(|refusal| refusal.kind == kind.code());
            (!is_lost).then_some(packet)
        });
        assert!(matches!(unsaid(&report).1, Answer::Refused { .. }), "{}", report.headline());
    }
}

/// The tries of a request.
const TRIES: usize = 8;

#[test]
fn a_link_that_loses_all_that_a_board_says_for_a_while_makes_no_sound_board_fail() {
    for kind in [Kind::TableCrc, Kind::TableRead, Kind::Records, Kind::Configure, Kind::Reset] {
        let mut lost = 0;
        let report = saying(move |packet| {
            let begins = refusal(&packet).is_some_and(|refusal| refusal.kind == kind.code());
            let is_lost = (begins || lost > 0) && lost < TRIES;
            lost += usize::from(is_lost);
            (!is_lost).then_some(packet)
        });
        assert!(matches!(unsaid(&report).1, Answer::Refused { .. }), "{}", report.headline());
    }
}

/// The report does not tell a user of `verify` to run it.
#[test]
fn a_row_that_does_not_come_back_after_what_was_refused_is_told_of() {
    let report = saying(|packet| {
        let row = |row: RowOut<'_>| (row.place.frame, row.place.row);
        let is_lost = matches!(packet.reply(), Some(Reply::RowOut(out)) if row(out) == (FRAME, 1));
        (!is_lost).then_some(packet)
    });
    assert_eq!(unsaid(&report), (Rule::Rows, &Answer::Row { row: 1, frame: FRAME }));
    assert!(!report.headline().contains("halfrow verify"), "{}", report.headline());
}

#[test]
fn a_board_that_took_a_row_and_says_that_none_is_inside_is_told_of() {
    // The window says whether the row has entered. If it has not, it may still be waiting.
    for (behind, verdict) in [(0, Verdict::Fail), (1, Verdict::Error)] {
        let report = saying(move |mut packet| match packet.reply() {
            Some(Reply::Status(status)) => {
                let is_inside = status.core_busy == 1;
                packet = packet.saying(&Reply::Status(Status { core_busy: 0, ..status }));
                packet.header.window -= if is_inside { behind } else { 0 };
                Some(packet)
            }
            _ => Some(packet),
        });
        assert_eq!(report.verdict(), verdict, "{}", report.headline());
        let told = "0 rows inside the core; the right number is 1";
        assert!(report.headline().contains(told), "{}", report.headline());
        let is_doubted = matches!(report.finding, Finding::WrongOverDoubtfulLink { .. });
        assert_eq!(is_doubted, verdict == Verdict::Error, "{}", report.headline());
    }
}

/// Both copies of a request may be lost, too; then nothing is reported of the board.
#[test]
fn a_link_that_loses_what_must_be_refused_does_not() {
    let report = altering(|toward, packet| {
        let is_short_row = packet.is(Kind::RowIn) && packet.payload.len() > 14 + 96;
        let lost = toward == Toward::Board && is_short_row;
        if lost { Vec::new() } else { vec![packet] }
    });
    assert_eq!(
        (report.verdict(), check(&report).outcome),
        (Verdict::Error, Outcome::Error),
        "{}",
        report.headline()
    );
}

#[test]
fn a_row_that_comes_back_wrong_after_what_was_refused_fails() {
    let report = saying(|packet| {
        Some(packet.with_row(|row, packed| {
            if row.place.frame == FRAME && row.place.row == 2 {
                packed[3] ^= 4;
            }
        }))
    });
    let right = Answer::Row { row: 2, frame: FRAME };
    let (rule, must, Answer::OtherRow { differs }) = broken(&report) else { panic!("{}", report.headline()) };
    assert_eq!((rule, must), (Rule::Rows, &right), "{}", report.headline());
    // Bit 2 of byte 3, which is the low byte of sample 2.
    let [RowPart::Samples { differing: 1, column: 2, found, right }] = **differs else {
        panic!("{differs:?}")
    };
    assert_eq!(found ^ right, 4);
    let told =
        format!("returned it with 1 wrong sample (the first, in column 2, is {found} instead of {right})");
    assert!(report.headline().contains(&told), "{}", report.headline());
}

/// What a row that is otherwise right may say of itself.
type Statement = (fn(&mut RowOut<'_>), fn(&RowPart) -> bool, &'static str);

#[test]
fn what_a_row_says_wrongly_of_itself_is_told() {
    let statements: [Statement; 4] = [
        (
            |row| row.pauses += 5,
            |part| matches!(part, RowPart::Pauses { found: 5, right: 0 }),
            "returned it with pauses of 5 board clocks instead of 0",
        ),
        (
            |row| row.entered = row.entered.map(|crc| !crc),
            |part| matches!(part, RowPart::Entered { found: Some(_), .. }),
            "as the CRC of the samples that entered the core",
        ),
        (
            |row| row.generation ^= 7,
            |part| matches!(part, RowPart::Generation { .. }),
            "returned it with generation ",
        ),
        (
            |row| row.last_latency += 1,
            |part| matches!(part, RowPart::LastLatency { found, right } if found - right == 1),
            "for its last sample",
        ),
    ];
    for (change, is_meant, told) in statements {
        let report = saying(move |packet| {
            Some(packet.with_row(|row, _| {
                if row.place.frame == FRAME && row.place.row == 2 {
                    change(row);
                }
            }))
        });
        let (.., Answer::OtherRow { differs }) = broken(&report) else { panic!("{}", report.headline()) };
        let [part] = &**differs else { panic!("{differs:?}") };
        assert!(is_meant(part), "{part:?}");
        assert!(report.headline().contains(told), "{}", report.headline());
    }
}

#[test]
fn a_row_that_is_trapped_otherwise_than_it_is_fails() {
    let report = saying(|packet| match packet.reply() {
        Some(Reply::Trap(Some(kept))) => {
            let other = TrappedRow { row: kept.row + 1, ..kept };
            Some(packet.saying(&Reply::Trap(Some(other))))
        }
        _ => Some(packet),
    });
    assert_eq!(broken(&report).0, Rule::Trap);
}

#[test]
fn a_burst_that_never_ends_is_told_with_what_was_said_of_it() {
    let report = saying(|packet| match packet.reply() {
        Some(Reply::Records(records)) if records.state == BurstState::Ended => {
            let state = BurstState::UnderWay;
            Some(packet.saying(&Reply::Records(Records { state, ..records })))
        }
        _ => Some(packet),
    });
    assert_eq!(broken(&report).0, Rule::Ended);
    let said = "must answer RECORDS with a burst that has ended and 2 records, but it answered with one under way and 2 records";
    assert!(report.headline().contains(said), "{}", report.headline());
}

#[test]
fn a_commit_that_is_not_checked_passes_but_for_the_rules() {
    let fault = "mock,fault=unchecked-commit";
    let report = judge_by_plan(&plan(), open(fault));
    assert_eq!(broken(&report).0, Rule::CommitCrc, "{}", report.headline());
    let without = Plan { selection: Some(Selection::least().with(Part::Corners, 1)), ..System::TINY.plan() };
    let report = judge_by_plan(&without, open(fault));
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert_eq!(check(&report).finding, Finding::RulesLeftOut {});
    assert!(report.not_exercised.contains(&NotExercised::Rules {}));
}

/// What a board must answer about bursts is a rule like any other, however long it is judged at speed.
#[test]
fn a_board_whose_trap_keeps_nothing_breaks_a_rule_also_where_no_time_is_spent_at_speed() {
    let plan = Plan { at_speed: AtSpeed::Off, ..System::TINY.plan() };
    let nothing_kept = |toward, mut packet: Passing| {
        if toward == Toward::Host && packet.is(Kind::Trap) {
            packet.payload = vec![0];
        }
        vec![packet]
    };
    let report = judge_by_plan(&plan, Altered::new(&Options::default(), nothing_kept).candidate());
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(failed_check(&report), Some(CheckName::Rules));
}

/// Only the widest rows of the rules need address line 7: 128 samples and more.
#[test]
fn samples_that_differ_in_rows_of_the_rules_are_told_with_the_size_of_these() {
    let report = judge_by_plan(&plan(), open("mock,fault=stuck-address,bit=7,value=1"));
    let told = "samples differ in rows that the rules were tried with (2048 x 1); the suspect is line memory";
    assert!(report.headline().contains(told), "{}", report.headline());
}
