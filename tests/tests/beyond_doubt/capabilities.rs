//! Boards that claim what no board can have: refused, with the name of the capability, and never judged.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfrow::board::{Board, OpenFailed, OpenOptions};
use halfrow::result::examples;
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_model::{MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH};
use halfrow_protocol::message::{Capabilities, Grids, Welcome};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge_claims, judge_claims_by, judge_each};
use halfrow_tests::system::{System, streamed};

/// A capability, named as in WIRE.md, with the claimed value, and what makes the claim.
type Claim = (&'static str, fn(&mut Capabilities));

/// Claims that no board can make. The values are just outside the ranges of WIRE.md section 3 and DATAPATH.md.
const IMPOSSIBLE: &[Claim] = &[
    ("max_width = 63", |board| board.max_width = 63),
    ("max_width = 2047", |board| board.max_width = 2047),
    ("max_width = 2593", |board| board.max_width = 2593),
    ("max_height = 0", |board| board.max_height = 0),
    ("max_height = 2049", |board| board.max_height = 2049),
    ("depths = 0", |board| board.depths = 0),
    ("depths = 248", |board| board.depths = 0xf8),
    ("taps = 0", |board| board.taps = 0),
    ("taps = 6", |board| board.taps = 6),
    ("taps = 255", |board| board.taps = 255),
    ("latency = 0", |board| board.latency = 0),
    ("latency = 2", |board| board.latency = 2),
    ("latency = 33", |board| board.latency = 33),
    ("ring = 0", |board| board.ring = 0),
    ("ring = 1", |board| board.ring = 1),
    ("ring = 100", |board| (board.ring, board.max_width) = (100, 64)),
    ("ring = 65535", |board| board.ring = 65_535),
    ("ring = 1024", |board| board.ring = 1024),
    ("table_banks = 0", |board| board.table_banks = 0),
    ("table_banks = 3", |board| board.table_banks = 3),
    ("row_banks_in = 1", |board| board.row_banks_in = 1),
    ("row_banks_out = 1", |board| board.row_banks_out = 1),
    ("step_ports = 0", |board| board.step_ports = 0),
    ("kernel_ports = 0", |board| board.kernel_ports = 0),
    ("clock_source = 3", |board| board.clock_source = 3),
    ("clock_source = 255", |board| board.clock_source = 255),
    ("records = 0", |board| records(board, 0)),
    ("records = 1", |board| records(board, 1)),
    ("entries = 0", |board| grids(board, |grids| grids.entries = 0)),
    ("entries = 2047", |board| grids(board, |grids| grids.entries = 2047)),
    ("ks = 0", |board| grids(board, |grids| grids.ks = 0)),
    ("ks = 159", |board| grids(board, |grids| grids.ks = 0x9f)),
];

fn records(board: &mut Capabilities, records: u16) {
    board.bursts.iter_mut().for_each(|bursts| bursts.records = records);
}

fn grids(board: &mut Capabilities, change: fn(&mut Grids)) {
    change(board.grids.as_mut().unwrap());
}

/// Claims that are unusual, but legal.
const UNUSUAL: &[Claim] = &[
    ("the least", |board| (board.max_width, board.max_height, board.ring) = (64, 8, 64)),
    ("the most", |board| (board.max_width, board.max_height, board.ring) = (2592, 2048, 16_384)),
    ("few records", |board| records(board, 2)),
    ("12 bits alone", |board| board.depths = 4),
    ("a depth to come", |board| board.depths = 0x0f),
    ("the most entries", |board| grids(board, |grids| (grids.entries, grids.ks) = (u16::MAX, 0x20))),
    ("another k besides", |board| grids(board, |grids| grids.ks = 0xd0)),
    ("a further datapath to come", |board| grids(board, |grids| (grids.further_datapath, grids.ks) = (3, 0))),
];

#[test]
fn a_board_that_cannot_be_is_refused_by_the_capability_s_name() {
    for &(claim, change) in IMPOSSIBLE {
        let report = judge_claims(&System::TINY, change);
        assert_eq!(report.cause, Cause::Refused, "{claim}: {}", report.headline());
        assert!(
            report.headline().contains(&format!("the board says {claim}, but ")),
            "{}",
            report.headline()
        );
        assert!(report.frames.is_empty());
    }
}

#[test]
fn a_board_that_cannot_be_is_refused_by_whoever_opens_it() {
    for &(claim, change) in IMPOSSIBLE {
        let claims = move |_, packet: Passing| match packet.reply() {
            Some(Reply::Capabilities(mut capabilities)) => {
                change(&mut capabilities);
                vec![packet.saying(&Reply::Capabilities(capabilities))]
            }
            _ => vec![packet],
        };
        let link = Altered::new(&Options::default(), claims).candidate().link;
        let OpenFailed { error, .. } = Board::open(link, &OpenOptions::default()).map(drop).unwrap_err();
        assert_eq!(error.cause(), Cause::Refused, "{claim}: {error}");
        assert!(error.to_string().contains(&format!("the board says {claim}, but ")), "{error}");
    }
}

/// What is explained of a code is what a run with it shows.
#[test]
fn the_example_of_an_impossible_capability_has_the_verdict_of_a_run() {
    let report = judge_claims(&System::TINY, |board| board.latency = 33);
    let examples = examples::findings_with_verdicts();
    let example = examples.iter().find(|(_, finding)| finding.code() == report.finding.code());
    let (verdict, finding) = example.unwrap();
    assert_eq!(*verdict, Some(report.verdict()), "{}", report.headline());
    assert_eq!(finding.technician(), None);
}

/// The sizes that a board may claim are those that the datapath allows.
#[test]
fn the_page_of_the_wire_names_the_sizes_that_the_model_has() {
    let page = include_str!("../../../protocol/WIRE.md");
    let width = format!("| 02 | `u16` max_width | samples, even, {MIN_WIDTH} to {MAX_WIDTH} |");
    let height = format!("| 03 | `u16` max_height | rows, 1 to {MAX_HEIGHT} |");
    [width, height].iter().for_each(|row| assert!(page.contains(row), "{row}"));
}

/// The mock has 4 input banks. A claim of more is credit that it does not give; a claim of fewer is less credit than it gives.
#[test]
fn a_board_with_other_row_banks_than_it_says_fails() {
    for (banks, change) in [
        (2, (|board| board.row_banks_in = 2) as fn(&mut Capabilities)),
        (3, |board| board.row_banks_in = 3),
        (5, |board| board.row_banks_in = 5),
        (255, |board| board.row_banks_in = 255),
    ] {
        let report = judge_claims(&System::TINY, change);
        assert_eq!(report.verdict(), Verdict::Fail, "{banks}: {}", report.headline());
        let said = format!("must give credit for {banks} rows after RESET, but it gave credit for 4");
        assert!(report.headline().contains(&said), "{}", report.headline());
    }
}

#[test]
fn a_board_that_is_only_unusual_is_judged() {
    for &(claim, change) in UNUSUAL {
        // Without corners and rules: those would be about a board that does not exist.
        let report = judge_claims_by(&streamed(System::TINY.plan()), change);
        assert_eq!(report.cause, Cause::Equal, "{claim}: {}", report.headline());
    }
}

/// WIRE.md, tag 10: a host does not ask for bursts whose content it does not know.
#[test]
fn a_board_is_asked_for_no_bursts_of_unknown_content() {
    let asked = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&asked);
    let report = judge_each(&System::TINY, move |toward, packet| {
        let is_of_bursts = [Kind::Burst, Kind::Records, Kind::Expect, Kind::Trap].map(|kind| packet.is(kind));
        seen.fetch_or(toward == Toward::Board && is_of_bursts.contains(&true), Ordering::Relaxed);
        match packet.reply() {
            Some(Reply::Capabilities(mut board)) => {
                board.bursts.iter_mut().for_each(|bursts| bursts.content = 2);
                packet.saying(&Reply::Capabilities(board))
            }
            _ => packet,
        }
    });
    assert_eq!(report.cause, Cause::Equal, "{}", report.headline());
    assert!(!asked.load(Ordering::Relaxed));
}

/// What is changed in an answer to HELLO, and what is reported then.
type Greeting = (fn(&mut Welcome), &'static str);

#[test]
fn a_greeting_that_no_board_answers_with_is_refused() {
    let greetings: [Greeting; 2] = [
        (|welcome| welcome.session = 0, "the device that answers is not a halfrow board"),
        (|welcome| welcome.version = 2, "the board speaks version 2 of the wire and this program version 1"),
    ];
    for (change, said) in greetings {
        let report = judge_each(&System::TINY, move |_, packet: Passing| match packet.reply() {
            Some(Reply::Hello(mut welcome)) => {
                change(&mut welcome);
                packet.saying(&Reply::Hello(welcome))
            }
            _ => packet,
        });
        assert_eq!(report.cause, Cause::Refused, "{}", report.headline());
        assert!(report.headline().contains(said), "{}", report.headline());
    }
}

/// The list of a CAPABILITIES reply with `value` for `tag`, or without that tag.
fn with(list: &[u8], tag: u8, value: Option<&[u8]>) -> Vec<u8> {
    let (mut rest, mut other) = (list, Vec::new());
    while let [of, length, after @ ..] = rest {
        let (own, behind) = after.split_at(usize::from(*length));
        if let Some(own) = if *of == tag { value } else { Some(own) } {
            other.extend([*of, own.len() as u8]);
            other.extend(own);
        }
        rest = behind;
    }
    other
}

/// The level of RESET that closes a session.
const CLOSES: u8 = 1;

#[test]
fn a_board_whose_capabilities_cannot_be_read_is_refused_and_left_free() {
    let spoilt: [(u8, Option<&[u8]>, &str); 4] = [
        (0x05, None, "taps"),
        (0x20, Some(&[0]), "nature"),
        (0x20, Some(&[4]), "nature"),
        (0x10, Some(&[1, 0]), ""),
    ];
    for (tag, value, name) in spoilt {
        let closed = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&closed);
        let report = judge_each(&System::TINY, move |toward, packet| {
            if toward == Toward::Board && packet.is(Kind::Reset) && packet.payload[0] == CLOSES {
                seen.store(true, Ordering::Relaxed);
            }
            if toward == Toward::Host && packet.is(Kind::Capabilities) {
                return Passing { payload: with(&packet.payload, tag, value), ..packet };
            }
            packet
        });
        assert_eq!(report.cause, Cause::Refused, "{tag:#x}: {}", report.headline());
        assert!(report.headline().contains(name), "{}", report.headline());
        assert!(closed.load(Ordering::Relaxed), "{tag:#x}: the session stays open");
    }
}
