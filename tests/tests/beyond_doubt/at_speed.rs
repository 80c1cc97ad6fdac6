//! Frames that a board makes by itself: what is wrong with them is the board's fault, what is missing is nobody's, and what was
//! not judged is reported.

use halfrow::link;
use halfrow::progress::Silent;
use halfrow::result::{
    BurstCount, Check, CheckName, Defect, EqualAtSpeed, Finding, NoBurst, NotExercised, Outcome, Repetition,
    Report, Streamed, Suspect,
};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{BurstMode, BurstState, FrameRecord, Records, Request};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge_claims, judge_each};
use halfrow_tests::system::{System, failed_check, streamed};

const TINY: System = System::TINY;
/// Its H.
const HEIGHT: u32 = TINY.height as u32;

fn check(report: &Report) -> &Check {
    report.checks.iter().find(|check| check.name == CheckName::AtSpeed).unwrap()
}

/// The report on a board after `change` was made to its record of frame 1 of its first burst.
fn with_record(change: impl Fn(&mut FrameRecord) + Send + 'static) -> Report {
    let mut done = false;
    judge_each(&TINY, move |toward, packet| {
        if done || toward == Toward::Board || !packet.is(Kind::Records) {
            return packet;
        }
        packet.with_records(|from, records| {
            let place = 1_usize.checked_sub(from as usize);
            if let Some(record) = place.and_then(|place| records.get_mut(place)) {
                change(record);
                done = true;
            }
        })
    })
}

#[test]
fn a_sound_board_passes_with_three_frames_and_both_banks() {
    let report = TINY.judge("");
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    let Finding::EqualAtSpeed(EqualAtSpeed { frames: 3, held_back: 0, .. }) = check(&report).finding else {
        panic!("{}", check(&report).detail())
    };
    assert_eq!(check(&report).outcome, Outcome::Passed);
    let untested = |part: &NotExercised| {
        matches!(part, NotExercised::FullSpeed {} | NotExercised::TableChangeAtSpeed {})
    };
    assert!(!report.not_exercised.iter().any(untested), "{:?}", report.not_exercised);
}

#[test]
fn a_wrong_signature_fails_and_what_does_not_come_again_is_said() {
    let report = with_record(|record| record.signature ^= 1);
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let Finding::DiffersAtSpeed { wrong: 1, first: 1, repetition: Repetition::AllRight { .. }, .. } =
        report.finding
    else {
        panic!("{}", report.headline())
    };
    assert!(report.headline().contains("repeated by itself, it was right"), "{}", report.headline());
    assert!(matches!(report.suspects[0].defect, Defect::SeenAtSpeed { row: None, lost: None, .. }));
    assert!(report.suspects[0].designer().starts_with("If streamed frames"), "{:?}", report.suspects);
}

/// A fault of the mock, the place that is suspected, which is empty for none, and a part of the sentence.
type SpeedFault = (&'static str, &'static str, &'static str);

/// What only frames at full speed show: 64 x 8 samples a frame, three frames.
const SPEED_FAULTS: [SpeedFault; 5] = [
    (
        "slow-path,one-in=300",
        "fails at the full pixel clock, seen in bit 5 of the corrected samples",
        "repeated, it was wrong again",
    ),
    ("warm-bit", "fails at the full pixel clock, seen in bit 5 of the corrected samples", "first in row 3"),
    ("warm-bit,after=1,row=7,bit=11", "seen in bit 11 of the corrected samples", "first in row 7"),
    ("late-swap", "the change of table banks between two frames", "2 of 3 frames differ at speed"),
    ("hidden-pause", "", "a maximum latency of 45 pixel clocks"),
];

#[test]
fn what_fails_at_full_speed_alone_passes_row_by_row_and_fails_in_a_burst() {
    let judged = |fault: &str, plan: Plan| {
        let candidate = link::open(&format!("mock,fault={fault}").parse().unwrap()).unwrap();
        verify(&Plan { fail_fast: false, ..plan }, candidate, &RunOptions::default(), &Silent).unwrap().report
    };
    for (fault, place, sentence) in SPEED_FAULTS {
        let unseen = judged(fault, streamed(TINY.plan()));
        assert_eq!(unseen.verdict(), Verdict::Pass, "{fault}: {}", unseen.headline());
        let seen = judged(fault, TINY.plan());
        assert_eq!(failed_check(&seen), Some(CheckName::AtSpeed), "{fault}: {}", seen.headline());
        assert!(seen.headline().contains(sentence), "{fault}: {}", seen.headline());
        let suspected = seen.suspects.first().map(Suspect::place).unwrap_or_default();
        assert!(suspected.contains(place), "{fault}: {suspected}: {}", seen.headline());
        assert_eq!(suspected.is_empty(), place.is_empty(), "{fault}: {suspected}");
        assert!(seen.remedy().is_some(), "{fault}");
    }
}

/// A count in a record, how it is spoilt, and the right value.
type Count = (BurstCount, fn(&mut FrameRecord), u32);

#[test]
fn every_count_of_a_record_is_compared() {
    // TINY is 64 columns wide, and L of the mock is 12.
    let latency = TINY.width as u32 / 2 + 12;
    let counts: [Count; 5] = [
        (BurstCount::Samples, |record| record.samples -= 1, TINY.width as u32 * HEIGHT),
        (BurstCount::Rows, |record| record.rows += 1, HEIGHT),
        (BurstCount::LeastLatency, |record| record.least_latency -= 1, latency),
        (BurstCount::MostLatency, |record| record.most_latency += 1, latency),
        (BurstCount::Generation, |record| record.generation = 1, 0),
    ];
    for (spoilt, change, expected) in counts {
        let report = with_record(change);
        assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
        let Finding::MiscountedAtSpeed { frame: 1, count, right, .. } = report.finding else {
            panic!("{}", report.headline())
        };
        assert_eq!((count, right), (spoilt, expected));
    }
}

#[test]
fn records_of_more_frames_than_were_asked_for_are_a_fault() {
    let report = judge_each(&TINY, |toward, packet| match toward {
        Toward::Host if packet.is(Kind::Records) => {
            packet.with_records(|_, records| records.extend(records.last().copied()))
        }
        _ => packet,
    });
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let miscounted =
        Finding::MiscountedAtSpeed { frame: 3, count: BurstCount::Records, counted: 4, right: 3 };
    assert_eq!(report.finding, miscounted);
}

#[test]
fn pauses_make_frames_no_frames_at_speed_and_not_wrong() {
    let report = with_record(|record| record.pauses = 7);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert_eq!(check(&report).finding, Finding::PausedAtSpeed { frames: 3, paused: 1 });
    assert_eq!(check(&report).outcome, Outcome::Skipped);
    assert!(report.not_exercised.contains(&NotExercised::FullSpeed {}));
}

#[test]
fn why_nothing_was_tested_at_speed_is_said() {
    let (none, other) = (NoBurst::BoardMakesNone {}, NoBurst::ContentUnknown { content: 2, known: 1 });
    let without = TINY.judge(",bursts=no");
    let unknown = judge_claims(&TINY, |board| {
        board.bursts.iter_mut().for_each(|bursts| bursts.content = 2);
    });
    let plan = Plan { at_speed: AtSpeed::Off, ..TINY.plan() };
    let candidate = Altered::new(&Options::default(), |_, packet: Passing| vec![packet]).candidate();
    let unasked = verify(&plan, candidate, &RunOptions::default(), &Silent).unwrap().report;
    for (report, reason) in [(without, none), (unknown, other), (unasked, NoBurst::NotAskedFor {})] {
        assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
        assert_eq!(check(&report).finding, Finding::NothingAtSpeed { reason });
        assert_eq!(check(&report).outcome, Outcome::Skipped);
        assert!(report.not_exercised.contains(&NotExercised::FullSpeed {}));
    }
}

#[test]
fn with_one_bank_the_change_of_tables_stays_untested() {
    let report = TINY.judge(",table-banks=1");
    assert!(matches!(check(&report).finding, Finding::EqualAtSpeed(EqualAtSpeed { frames: 3, .. })));
    assert!(report.not_exercised.contains(&NotExercised::TableChangeAtSpeed {}));
}

/// The report on a board that says that the burst goes on, or is over, and gives no record.
fn without_records(state: BurstState) -> Report {
    judge_each(&TINY, move |toward, packet| match packet.reply() {
        Some(Reply::Records(found)) if toward == Toward::Host => {
            packet.saying(&Reply::Records(Records { state, bytes: &[], ..found }))
        }
        _ => packet,
    })
}

#[test]
fn frames_that_never_come_are_no_verdict() {
    let report = without_records(BurstState::UnderWay);
    assert_eq!(report.cause, Cause::Station, "{}", report.headline());
    assert!(matches!(report.finding, Finding::BurstStalled { frame: 0, frames: 3, .. }));
    for state in [BurstState::Ended, BurstState::None] {
        let report = without_records(state);
        assert_eq!(report.cause, Cause::Station, "{}", report.headline());
        assert_eq!(report.finding, Finding::BurstEndedEarly { came: 0, frames: 3 });
    }
}

/// The packet as a board receives it that uses another seed than the host sent, so that it makes other frames each time: of no row
/// near them, of which the low bits of the seed decide.
fn with_another_seed(toward: Toward, mut packet: Passing) -> Passing {
    if toward == Toward::Board && packet.is(Kind::Burst) {
        // WIRE.md, BURST: burst, frames, seed.
        packet.payload[9] ^= 0x50;
    }
    packet
}

#[test]
fn a_frame_that_is_wrong_again_has_its_first_wrong_row_trapped() {
    let report = judge_each(&TINY, with_another_seed);
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let Finding::DiffersAtSpeed {
        first: 0, repetition: Repetition::Trapped { row: 0, streamed, .. }, ..
    } = report.finding
    else {
        panic!("{}", report.headline())
    };
    assert_eq!(streamed, Streamed::Right);
    let places: Vec<_> = report.suspects.iter().map(|suspect| &suspect.defect).collect();
    assert!(matches!(places[..], [Defect::OnlyAtSpeed { row: Some(0), samples: 1.., .. }, ..]), "{places:?}");
}

#[test]
fn what_is_wrong_at_any_clock_is_not_called_a_matter_of_speed() {
    let report = TINY.judge(",fault=row-factor,row=40,bit=20,hidden=true");
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    assert!(
        report.headline().contains("first in row 40; sent row by row, the same frame is wrong as well"),
        "{}",
        report.headline()
    );
    let is_of_speed =
        |suspect: &Suspect| matches!(suspect.defect, Defect::OnlyAtSpeed { .. } | Defect::SeenAtSpeed { .. });
    assert!(!report.suspects.iter().any(is_of_speed), "{:?}", report.suspects);
    assert!(report.suspects[0].place().contains("row 40's factor, bit 20"), "{}", report.headline());
}

/// The trapped row is still reported, but no more than is known.
#[test]
fn a_frame_that_cannot_be_streamed_again_is_said_to_be_seen_at_speed_alone() {
    let mut is_kept = false;
    let board = Altered::new(&Options::default(), move |toward, packet| {
        is_kept |= matches!(packet.reply(), Some(Reply::Trap(Some(_))));
        if is_kept && packet.is(Kind::RowIn) {
            return Vec::new();
        }
        vec![with_another_seed(toward, packet)]
    });
    let report = TINY.judge_candidate(board.candidate());
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    let Finding::DiffersAtSpeed { repetition: Repetition::Trapped { row: 0, streamed, .. }, .. } =
        report.finding
    else {
        panic!("{}", report.headline())
    };
    assert_eq!(streamed, Streamed::RowLost { row: 0 });
    let first = &report.suspects[0].defect;
    assert!(matches!(first, Defect::SeenAtSpeed { row: Some(0), lost: Some(0), .. }), "{first:?}");
}

#[test]
fn without_a_trap_it_is_said_that_no_row_was_kept() {
    let report = judge_each(&TINY, |toward, packet| match packet.reply() {
        Some(Reply::Capabilities(mut capabilities)) if toward == Toward::Host => {
            capabilities.bursts.iter_mut().for_each(|bursts| bursts.trap = false);
            packet.saying(&Reply::Capabilities(capabilities))
        }
        _ => with_another_seed(toward, packet),
    });
    let Finding::DiffersAtSpeed { repetition: Repetition::NoTrap {}, .. } = report.finding else {
        panic!("{}", report.headline())
    };
    assert!(report.headline().contains("of which the board kept no row"), "{}", report.headline());
}

/// A board that keeps using the active tables makes every second frame wrong as a whole.
#[test]
fn frames_of_the_other_tables_are_known_by_their_signatures() {
    let report = judge_each(&TINY, |toward, mut packet| {
        if toward == Toward::Board
            && packet.is(Kind::Burst)
            && matches!(packet.request(), Some(Request::Burst(burst)) if burst.mode == BurstMode::Alternating)
        {
            packet.payload[16] = BurstMode::Fresh as u8;
        }
        packet
    });
    assert_eq!(failed_check(&report), Some(CheckName::AtSpeed), "{}", report.headline());
    assert_eq!(report.suspects[0].defect, Defect::TablesChangeLate { rows: HEIGHT as usize });
    assert!(matches!(
        report.finding,
        Finding::DiffersAtSpeed { first: 1, repetition: Repetition::NotNeeded {}, .. }
    ));
    // A frame of a corner follows no other frame.
    let corner = System { height: 1, ..TINY }.judge(",fault=stale-table-hidden");
    assert!(matches!(corner.suspects[0].defect, Defect::StaleTables { .. }), "{:?}", corner.suspects);
}

#[test]
fn a_row_that_changes_on_its_way_in_is_not_said_to_be_computed_wrongly() {
    let report = judge_each(&TINY, |toward, mut packet| {
        if toward == Toward::Board
            && matches!(
                packet.request(),
                Some(Request::RowIn(row)) if row.place.frame == 2 && row.place.row == 3
            )
        {
            // The samples follow the place. Whatever they are, this changes them.
            packet.payload[12..].iter_mut().for_each(|byte| *byte ^= 0x11);
        }
        packet
    });
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
    assert_eq!(report.finding, Finding::RowsEnteredChanged { rows: 1, row: 3, frame: 2, flipped: None });
    let defect = Defect::RowsChangedOnEntry { rows: 1, first: 3, frame: 2, flipped: None };
    assert_eq!(report.suspects[0].defect, defect);
    assert!(report.headline().contains("not in the computation"), "{}", report.headline());
}

#[test]
fn a_wrong_crc_of_what_entered_is_the_counts_fault_and_not_the_row_s() {
    let mut done = false;
    let report = judge_each(&TINY, move |_, mut packet| {
        if packet.is(Kind::RowOut) && !done {
            done = true;
            // `entered` ends the packet.
            packet.payload.last_mut().into_iter().for_each(|byte| *byte ^= 1);
        }
        packet
    });
    assert_eq!(
        report.finding,
        Finding::EntryMiscounted { rows: 1, row: 0, frame: 0 },
        "{}",
        report.headline()
    );
}

/// What follows the samples means nothing on a board that lacks capability 11.
#[test]
fn without_the_capability_nothing_is_read_after_the_samples() {
    let report = judge_each(&TINY, |toward, mut packet| {
        if packet.is(Kind::RowOut) {
            packet.payload.last_mut().into_iter().for_each(|byte| *byte ^= 1);
        }
        match packet.reply() {
            Some(Reply::Capabilities(mut capabilities)) if toward == Toward::Host => {
                capabilities.entered = false;
                packet.saying(&Reply::Capabilities(capabilities))
            }
            _ => packet,
        }
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
}

/// The first try of a BURST arrives late, after the next burst, which it restarts.
#[test]
fn a_burst_that_comes_late_is_not_the_bitstreams_fault() {
    let (mut late, mut is_sent) = (None, false);
    let board = Altered::new(&Options::default(), move |toward, packet| {
        if toward == Toward::Host || !packet.is(Kind::Burst) || is_sent {
            return vec![packet];
        }
        let name = |packet: &Passing| match packet.request() {
            Some(Request::Burst(burst)) => burst.burst,
            other => panic!("{other:?}"),
        };
        match late.take() {
            None => {
                late = Some(packet);
                Vec::new()
            }
            Some(first) if name(&first) == name(&packet) => {
                late = Some(first);
                vec![packet]
            }
            Some(first) => {
                is_sent = true;
                vec![packet, first]
            }
        }
    });
    let report = TINY.judge_candidate(board.candidate());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    assert!(report.headline().contains("may have restarted an earlier burst"), "{}", report.headline());
}
