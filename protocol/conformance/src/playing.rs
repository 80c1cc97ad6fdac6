//! Section 5 of WIRE.md: samples, latencies and gaps of the rows that come back.

use halfrow_protocol::message::{Configuration, Hello, Request};
use halfrow_protocol::samples;
use proptest::prelude::*;

use crate::bench::{Bench, HELLO, rows_of};
use crate::frames::{Row, configuration, lean, ready, row, samples_of};
use crate::golden_rows::{HERMITE, KEYS};
use crate::material::{GOLDEN_FACTOR, Nodes, UNSTRETCHED, crc_of_words, hermite, keys, noise_row};
use crate::{Boards, Build, cases};

use crate::uploads::TableSet;

/// A board for frames of one row with this kernel and the golden factor.
fn golden(on: &dyn Boards, kernel: &Nodes) -> Bench {
    let mut bench = Bench::greeted(on);
    bench.done(&Request::Configure(configuration(1)));
    let tables = TableSet::new(&[GOLDEN_FACTOR], kernel);
    tables.upload(&mut bench);
    bench.done(&tables.commit(1, 0));
    bench
}

pub(crate) fn the_golden_rows_come_out_of_the_wire(on: &dyn Boards) {
    for (kernel, expected) in [(hermite(), HERMITE), (keys(), KEYS)] {
        assert_eq!(samples_of(&golden(on, &kernel).send_all(1, [0])[0].row()), expected);
    }
}

/// `entered` covers the samples as they came, those beyond the depth included.
pub(crate) fn the_crc_of_what_entered_is_that_of_the_samples_that_were_sent(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.done(&Request::Configure(Configuration { bits: 8, ..configuration(2) }));
    let tells = bench.capabilities().entered;
    let heard = bench.send_all(2, 0..2);
    for (number, packet) in (0..).zip(&heard) {
        let crc = tells.then(|| crc_of_words(row(2, number).samples));
        assert_eq!(packet.row().entered, crc, "row {number}");
        assert_eq!(packet.payload.len(), 12 + 8 + 96 + if crc.is_some() { 4 } else { 0 });
    }
    assert_eq!(heard.len(), 2);
}

pub(crate) fn every_row_has_its_own_factor(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    bench.done(&Request::Configure(configuration(3)));
    let tables = TableSet::new(&[UNSTRETCHED, GOLDEN_FACTOR, UNSTRETCHED], &hermite());
    tables.upload(&mut bench);
    bench.done(&tables.commit(1, 0));
    let rows = (0..3).map(|number| Row { samples: noise_row(0, 64), ..row(3, number) });
    let heard: Vec<_> = rows.flat_map(|row| bench.send(&row)).collect();
    let unchanged = noise_row(0, 64);
    let expected = [unchanged.as_slice(), &HERMITE, &unchanged];
    for (packet, expected) in heard.iter().zip(expected) {
        assert_eq!(samples_of(&packet.row()), expected);
    }
    assert_eq!(heard.len(), 3);
}

pub(crate) fn outputs_are_clamped_to_the_depth_and_inputs_go_in_as_they_are(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    bench.done(&Request::Configure(Configuration { bits: 8, ..configuration(1) }));
    let samples: Vec<u16> = (0..64).map(|column| column * 65).collect();
    let clamped: Vec<u16> = samples.iter().map(|&sample| sample.min(255)).collect();
    let heard = bench.send(&Row { samples, ..row(1, 0) });
    assert_eq!(samples_of(&heard[0].row()), clamped);
}

pub(crate) fn a_row_leaves_when_half_of_the_next_has_entered_and_a_frame_when_its_last_row_was_played(
    on: &dyn Boards,
) {
    let mut bench = ready(on, &Build::default(), 3);
    let heard: Vec<_> = (0..3).map(|number| rows_of(&bench.send_all(3, [number]))).collect();
    assert_eq!(heard, [vec![], vec![0], vec![1, 2]]);
}

pub(crate) fn latencies_are_half_a_row_and_l(on: &dyn Boards) {
    let of = |latency| Build { latency, ..Build::default() };
    for (build, width, delay) in [
        (of(4), 64, 36),
        (of(12), 64, 44),
        (of(32), 64, 64),
        (of(12), 66, 45),
        (of(12), 2048, 1036),
        (of(20), 2048, 1044),
        (lean(), 64, 43),
    ] {
        if !on.offers(&build) {
            continue;
        }
        let mut bench = ready(on, &build, 2);
        let centre2 = width - 1;
        bench.done(&Request::Configure(Configuration { width, centre2, ..configuration(2) }));
        for number in 0..2 {
            let mut row = Row { samples: vec![9; width.into()], ..row(2, number) };
            row.place.width = width;
            for packet in bench.send(&row) {
                let out = packet.row();
                assert_eq!(
                    (out.first_latency, out.last_latency),
                    (delay, delay),
                    "L {}, W {width}",
                    build.latency
                );
            }
        }
        assert_eq!(bench.status().rows_out, 2);
    }
}

pub(crate) fn without_a_seed_nothing_pauses(on: &dyn Boards) {
    let heard = ready(on, &Build::default(), 4).send_all(4, 0..4);
    assert!(heard.iter().all(|packet| packet.row().pauses == 0));
}

/// The generator of section 5 of WIRE.md, computed in 64 bits and cut to 32 where the page says so.
fn draws(seed: u32) -> impl Iterator<Item = u32> {
    let word = |x: u64| x & 0xffff_ffff;
    std::iter::successors(Some(seed.into()), move |&x| {
        let x = word(x ^ x << 13);
        let x = x ^ x >> 17;
        Some(word(x ^ x << 5))
    })
    .skip(1)
    .map(|x| x as u32)
}

/// Pauses inside the rows of a frame. There is one draw before every row but row 0, and one before every sample.
fn pauses(seed: u32, width: u16, height: u16) -> Vec<u16> {
    let mut draws = draws(seed);
    let row = |row| {
        if row > 0 {
            draws.next();
        }
        draws.by_ref().take(width.into()).filter(|draw| draw % 8 == 0).count() as u16
    };
    (0..height).map(row).collect()
}

/// Pauses of the rows of two frames that the board played with this seed and blanking.
fn pauses_of_board(on: &dyn Boards, gap_seed: u32, blanking: u16, height: u16) -> Vec<u16> {
    let mut bench = ready(on, &Build::default(), height);
    bench.done(&Request::Configure(Configuration { gap_seed, blanking, ..configuration(height) }));
    let mut heard = Vec::new();
    for number in 0..u32::from(height) * 2 {
        bench.window = heard.len() as u32;
        heard.extend(bench.send_all(height, [number]));
    }
    assert!(heard.iter().all(|packet| (packet.row().first_latency, packet.row().last_latency) == (44, 44)));
    heard.iter().map(|packet| packet.row().pauses).collect()
}

pub(crate) fn the_tests_own_pattern_is_marsaglias(_: &dyn Boards) {
    assert_eq!(draws(2_463_534_242).next(), Some(723_471_715));
    // Counted in Python.
    assert_eq!(pauses(1, 64, 4), [6, 15, 9, 10]);
}

pub(crate) fn gaps_follow_the_seed_and_begin_anew_with_every_frame(on: &dyn Boards) {
    proptest!(cases(on, 8, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/gaps.txt")), |(seed in 1_u32..,
        blanking in 0_u16..200,
        height in 1_u16..6,)| {
        let expected = pauses(seed, 64, height);
        prop_assert_eq!(pauses_of_board(on, seed, blanking, height), [expected.clone(), expected].concat());
    });
}

pub(crate) fn gaps_and_blanking_change_no_sample(on: &dyn Boards) {
    proptest!(cases(on, 8, concat!(env!("CARGO_MANIFEST_DIR"), "/proptest-regressions/blanking.txt")), |(seed in any::<u32>(), blanking in 0_u16..2000)| {
        let gaps = Configuration { gap_seed: seed, blanking, ..configuration(2) };
        expect_unchanged(&mut ready(on, &Build::default(), 2), gaps);
    });
}

pub(crate) fn blanking_without_a_seed_changes_no_sample(on: &dyn Boards) {
    for blanking in [1, 783, 2000] {
        let blanking = Configuration { blanking, ..configuration(2) };
        expect_unchanged(&mut ready(on, &Build::default(), 2), blanking);
    }
}

/// Checks that two frames of two rows come out unchanged.
fn expect_unchanged(bench: &mut Bench, configuration: Configuration) {
    bench.done(&Request::Configure(configuration));
    for (number, packet) in (0..).zip(bench.send_all(2, 0..4)) {
        assert_eq!(samples_of(&packet.row()), row(2, number).samples, "row {number}");
    }
    assert_eq!(bench.status().rows_out, 4);
}

pub(crate) fn samples_are_packed_two_in_three_bytes(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    let mut row = row(1, 0);
    (row.samples[0], row.samples[1]) = (0x123, 0xabc);
    let heard = bench.send(&row);
    assert_eq!(heard[0].row().packed[..3], [0x23, 0xc1, 0xab]);
    assert_eq!(heard[0].row().packed.len(), samples::packed_length(64));
}

pub(crate) fn a_row_that_a_new_session_cuts_off_leaves_no_trace(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    bench.send_all(2, [0]);
    bench.greet(&Hello { nonce: 8, ..HELLO });
    let other = Row { samples: noise_row(50, 64), ..row(2, 0) };
    let heard = [bench.send(&other), bench.send_all(2, [1])].concat();
    assert_eq!(rows_of(&heard), [0, 1]);
    assert_eq!(samples_of(&heard[0].row()), other.samples);
}
