//! AT-SPEED.md, *Ends* and *Trap*.

use std::time::Duration;

use halfrow_protocol::message::{
    Burst, BurstMode, BurstState, Expect, Hello, RefusalCode, Reply, Request, Reset, ResetLevel, TrappedRow,
};
use halfrow_protocol::samples;

use crate::Boards;
use crate::at_speed::{self, ENDLESS, FRAME, HEIGHT, ONE, ROWS, RecordsReply, golden_tables, ready};
use crate::bench::{Bench, HELLO, rows_of};
use crate::frames::{configuration, make_ready, row, samples_of};
use crate::material::crc_of_words;

/// A board in the middle of a burst.
fn under_way(on: &dyn Boards) -> Option<Bench> {
    let (mut bench, _) = ready(on)?;
    bench.done(&Request::Burst(ENDLESS));
    bench.records_when(0, |told| !told.records.is_empty());
    Some(bench)
}

/// Checks that two rows go through the board as if it had made no burst.
fn corrects_rows(bench: &mut Bench) {
    bench.done(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 }));
    make_ready(bench, 2);
    let heard = bench.send_all(2, 0..2);
    assert_eq!(rows_of(&heard), [0, 1]);
    for (number, packet) in (0..).zip(&heard) {
        assert_eq!(samples_of(&packet.row()), row(2, number).samples);
        assert_eq!((packet.row().first_latency, packet.row().last_latency), (44, 44));
    }
}

pub(crate) fn a_reset_of_any_level_ends_a_burst_at_once(on: &dyn Boards) {
    for level in [ResetLevel::Rows, ResetLevel::Tables] {
        let Some(mut bench) = under_way(on) else { return };
        bench.done(&Request::Reset(Reset { level, next_row: 0 }));
        let told = bench.records(0);
        assert_eq!((told.burst, told.state), (ENDLESS.burst, BurstState::Ended));
        assert!(told.records.iter().all(|record| record.signature == FRAME), "no frame is recorded in part");
        assert_eq!(bench.status().core_busy, 0);
        bench.done(&Request::Burst(ENDLESS));
        assert_eq!(bench.records(0), told, "what has ended goes on for no request");
        corrects_rows(&mut bench);
    }
    let Some(mut bench) = under_way(on) else { return };
    bench.done(&Request::Reset(Reset { level: ResetLevel::Session, next_row: 0 }));
    bench.greet(&HELLO);
    assert_eq!(bench.status().core_busy, 0);
    corrects_rows(&mut bench);
}

pub(crate) fn a_burst_can_follow_one_that_was_reset(on: &dyn Boards) {
    let Some(mut bench) = under_way(on) else { return };
    bench.done(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 }));
    let records = bench.signed(&Burst { burst: 2, frames: 2, ..ENDLESS });
    assert_eq!(records.iter().map(|record| record.signature).collect::<Vec<_>>(), [FRAME; 2]);
}

pub(crate) fn a_new_session_ends_a_burst_and_knows_none(on: &dyn Boards) {
    let Some(mut bench) = under_way(on) else { return };
    let hello = Hello { nonce: 5, host: 6, take_over: true, ..HELLO };
    bench.greet(&hello);
    assert_eq!(bench.records(0), RecordsReply { burst: 0, state: BurstState::None, records: vec![] });
    assert_eq!(bench.status().core_busy, 0);
    // The id of a burst of the previous session counts as a new one.
    assert_eq!(bench.signed(&Burst { frames: 1, ..ENDLESS })[0].signature, FRAME);
    corrects_rows(&mut bench);
}

pub(crate) fn a_repeated_hello_ends_nothing(on: &dyn Boards) {
    let Some(mut bench) = under_way(on) else { return };
    bench.greet(&HELLO);
    assert_eq!(bench.records(0).state, BurstState::UnderWay);
}

pub(crate) fn ten_seconds_of_silence_end_a_burst_and_its_session(on: &dyn Boards) {
    let Some(mut bench) = under_way(on) else { return };
    bench.now += Duration::from_millis(9900);
    assert_eq!(bench.records(0).state, BurstState::UnderWay);
    bench.now += Duration::from_millis(9900);
    bench.say(&Request::RowAck);
    bench.now += Duration::from_millis(9900);
    assert_eq!(bench.records(0).state, BurstState::UnderWay, "any packet of the session will do");
    bench.now += Duration::from_millis(10_100);
    assert_eq!(bench.refused(&Request::Records { from: 0 }), (RefusalCode::Session, 0));
    bench.greet(&HELLO);
    assert_eq!(bench.records(0), RecordsReply { burst: 0, state: BurstState::None, records: vec![] });
    corrects_rows(&mut bench);
}

pub(crate) fn silence_behind_a_burst_closes_nothing(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    let records = bench.signed(&ONE);
    bench.now += Duration::from_secs(25);
    assert_eq!(bench.records(0).records, records);
}

fn trapped(bench: &mut Bench) -> Option<(u32, u16, u32, Vec<u16>)> {
    let answer = bench.done(&Request::Trap);
    let Reply::Trap(kept) = answer.reply() else { panic!("{answer:?}") };
    kept.map(|TrappedRow { frame, row, width, signature, packed }| {
        let mut outputs = vec![0; width.into()];
        samples::unpack(packed, &mut outputs);
        (frame, row, signature, outputs)
    })
}

fn expect(bench: &mut Bench, signatures: [u32; 4]) {
    let bytes = signatures.map(u32::to_le_bytes);
    bench.done(&Request::Expect(Expect { first: 0, bytes: &bytes[..2] }));
    bench.done(&Request::Expect(Expect { first: 2, bytes: &bytes[2..] }));
}

/// A board with a trap.
fn with_trap(on: &dyn Boards) -> Option<Bench> {
    ready(on).filter(|(_, bursts)| bursts.trap).map(|(bench, _)| bench)
}

const TRAPPED: Burst = Burst { mode: BurstMode::Trapped, frames: 2, ..ONE };

pub(crate) fn the_trap_keeps_nothing_while_all_rows_are_expected(on: &dyn Boards) {
    let Some(mut bench) = with_trap(on) else { return };
    expect(&mut bench, ROWS);
    assert_eq!(trapped(&mut bench), None);
    let records = bench.signed(&TRAPPED);
    assert_eq!(records.iter().map(|record| record.signature).collect::<Vec<_>>(), [FRAME; 2]);
    assert_eq!(trapped(&mut bench), None);
}

pub(crate) fn the_trap_keeps_the_first_row_that_is_not_expected(on: &dyn Boards) {
    for wrong in [&[2][..], &[1, 3], &[3], &[0, 1, 2, 3]] {
        let Some(mut bench) = with_trap(on) else { return };
        let mut expected = ROWS;
        wrong.iter().for_each(|&row| expected[row] ^= 1 << 31);
        expect(&mut bench, expected);
        let records = bench.signed(&TRAPPED);
        assert_eq!(records[1].signature, FRAME, "a burst goes on as if nothing had been");
        let (frame, row, signature, outputs) = trapped(&mut bench).unwrap();
        assert_eq!((frame, usize::from(row), signature), (0, wrong[0], ROWS[wrong[0]]));
        assert_eq!((outputs.len(), crc_of_words(outputs)), (64, signature));
    }
}

pub(crate) fn a_row_that_nobody_uploaded_is_expected_to_have_0(on: &dyn Boards) {
    let Some(mut bench) = with_trap(on) else { return };
    bench.signed(&TRAPPED);
    assert_eq!(
        trapped(&mut bench).map(|(frame, row, signature, _)| (frame, row, signature)),
        Some((0, 0, ROWS[0]))
    );
}

pub(crate) fn expected_signatures_stay_whatever_happens(on: &dyn Boards) {
    let Some(mut bench) = with_trap(on) else { return };
    expect(&mut bench, ROWS);
    let reset = |level| Request::Reset(Reset { level, next_row: 0 });
    let hello = Request::Hello(Hello { nonce: 78, ..HELLO });
    for (burst, request) in (1..).zip([reset(ResetLevel::Rows), reset(ResetLevel::Tables), hello]) {
        bench.session = bench.done(&request).header.session;
        at_speed::make_ready(&mut bench, configuration(HEIGHT), &golden_tables());
        bench.signed(&Burst { burst, ..TRAPPED });
        assert_eq!(trapped(&mut bench), None, "{request:?}");
    }
}

pub(crate) fn only_a_trapped_burst_sets_the_trap_and_only_the_next_one_empties_it(on: &dyn Boards) {
    let Some(mut bench) = with_trap(on) else { return };
    bench.signed(&Burst { burst: 1, mode: BurstMode::Repeating, ..TRAPPED });
    assert_eq!(trapped(&mut bench), None);
    bench.signed(&Burst { burst: 2, ..TRAPPED });
    let kept = trapped(&mut bench);
    assert!(kept.is_some());
    bench.signed(&Burst { burst: 3, mode: BurstMode::Fresh, ..TRAPPED });
    assert_eq!(trapped(&mut bench), kept);
    expect(&mut bench, ROWS);
    assert_eq!(trapped(&mut bench), kept);
    bench.signed(&Burst { burst: 4, ..TRAPPED });
    assert_eq!(trapped(&mut bench), None);
}

pub(crate) fn a_reset_and_a_new_session_empty_the_trap(on: &dyn Boards) {
    let Some(mut bench) = with_trap(on) else { return };
    bench.signed(&TRAPPED);
    bench.done(&Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 }));
    assert_eq!(trapped(&mut bench), None);
    bench.signed(&Burst { burst: 2, ..TRAPPED });
    assert!(trapped(&mut bench).is_some());
    bench.greet(&Hello { nonce: 77, ..HELLO });
    assert_eq!(trapped(&mut bench), None);
}
