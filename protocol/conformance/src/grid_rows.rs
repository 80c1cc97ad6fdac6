//! Rows corrected by grids, and frames that change between grids and row factors.

use halfrow_protocol::message::{Commit, Configuration, Request, RowPlace, Shape};

use crate::bench::{Bench, ReceivedPacket};
use crate::frames::{Row, WIDTH, lean, row, samples_of};
use crate::grids::{greeted, narrow};
use crate::material::{
    GOLDEN_FACTOR, UNSTRETCHED, crc_of_words, drawn_grid, grid_size, hermite, keys, noise_row,
};
use crate::uploads::TableSet;
use crate::{Boards, Build};

const SHAPE: Shape = Shape { v: 1, k: 5 };

/// CRC-32 of each of the two rows of a frame of the specification's samples: corrected by the grid drawn from the seed 7, and by
/// the golden factor, with Hermite's kernel; and unchanged. Computed outside the project.
const DRAWN: [u32; 2] = [0x8d18_7855, 0xea71_8ae2];
const GOLDEN: [u32; 2] = [0x8b0d_0aa8, 0xd575_54e6];
const UNCHANGED: [u32; 2] = [0xe38d_756b, 0x0b58_cafb];

/// v, k, and the CRC-32 of all 70 rows of 200 samples together, corrected by the grid drawn from the seed 10v + k; with Keys'
/// kernel if v is odd, else Hermite's. Computed outside the project.
const SHAPES: [(u8, u8, u32); 12] = [
    (1, 5, 0xc1f2_6091),
    (1, 6, 0xd84d_156b),
    (2, 5, 0x2446_0cb2),
    (2, 6, 0x75a5_eadb),
    (3, 5, 0x5ef4_d802),
    (3, 6, 0xb4f1_7220),
    (4, 5, 0x1837_5a04),
    (4, 6, 0xe9ad_4e93),
    (5, 5, 0xd2e9_03f9),
    (5, 6, 0xe97d_a61e),
    (6, 5, 0x25f7_9761),
    (6, 6, 0x4a47_efbd),
];

/// A row of frames of 70 rows of 200 samples; `number` counts through all frames.
fn wide_row(number: u32) -> Row {
    let (frame, row) = ((number / 70) as u16, number % 70);
    let place = RowPlace { row_sequence: number, frame, row: row as u16, width: 200, last: row == 69 };
    Row { place, samples: noise_row(row, 200) }
}

pub(crate) fn every_shape_makes_the_rows_of_the_page(on: &dyn Boards) {
    let Some((mut bench, grids)) = greeted(on, &Build::default()) else { return };
    let blanking = if grids.grid_width > 200 { grids.grid_blanking } else { 0 };
    bench.done(&Request::Configure(Configuration {
        width: 200,
        centre2: 199,
        blanking: blanking.into(),
        ..narrow(&grids, 70)
    }));
    let shapes = SHAPES.into_iter().filter(|&(_, k, _)| grids.takes(k));
    for (frame, (v, k, expected)) in (0_u32..).zip(shapes) {
        let shape = Shape { v, k };
        let kernel = if v % 2 == 1 { keys() } else { hermite() };
        let entries = drawn_grid(shape, 200, 70, 10 * u32::from(v) + u32::from(k));
        let tables = TableSet::grid(shape, &entries, &kernel);
        tables.upload(&mut bench);
        bench.done(&tables.commit(frame as u8 + 1, frame as u16));
        let mut samples = Vec::new();
        for number in 70 * frame..70 * (frame + 1) {
            let heard = bench.send(&wide_row(number));
            samples.extend(heard.iter().flat_map(|packet| samples_of(&packet.row())));
            bench.window = number.saturating_sub(1);
        }
        bench.window = 70 * (frame + 1);
        assert_eq!(crc_of_words(samples), expected, "{shape:?}");
    }
}

/// A board of this build that takes grids, configured for frames of two rows of 64 samples.
fn configured(on: &dyn Boards, build: &Build) -> Option<Bench> {
    let (mut bench, grids) = greeted(on, build)?;
    bench.done(&Request::Configure(narrow(&grids, 2)));
    Some(bench)
}

fn drawn() -> TableSet {
    TableSet::grid(SHAPE, &drawn_grid(SHAPE, WIDTH, 2, 7), &hermite())
}

/// The golden factor at every node: a grid of equal factors is the same as one row factor for every row.
fn alike() -> TableSet {
    let (segments, grid_rows) = grid_size(SHAPE, WIDTH, 2);
    let nodes = vec![GOLDEN_FACTOR; (segments + 1) * grid_rows];
    TableSet::grid(SHAPE, &[vec![UNSTRETCHED; grid_rows], nodes].concat(), &hermite())
}

fn golden() -> TableSet {
    TableSet::new(&[GOLDEN_FACTOR; 2], &hermite())
}

/// The packets of a frame of two rows, with the samples of frame 0.
fn frame(bench: &mut Bench, number: u32) -> Vec<u8> {
    let rows = [0, 1].map(|row_in_frame| {
        let Row { place, .. } = row(2, 2 * number + row_in_frame);
        bench.row_packet(&Row { place, samples: noise_row(row_in_frame, WIDTH) })
    });
    rows.concat()
}

/// Generation and CRC-32 of the samples of each row.
fn made(heard: &[ReceivedPacket]) -> Vec<(u8, u32)> {
    heard.iter().map(|it| (it.row().generation, crc_of_words(samples_of(&it.row())))).collect()
}

/// What [`made`] returns for a frame made under this generation.
fn frame_of(generation: u8, rows: [u32; 2]) -> Vec<(u8, u32)> {
    rows.map(|crc| (generation, crc)).to_vec()
}

pub(crate) fn without_a_shape_or_with_v_0_rows_have_one_factor_each(on: &dyn Boards) {
    for shape in [None, Some(Shape { v: 0, k: 0 }), Some(Shape { v: 0, k: 255 })] {
        let Some(mut bench) = configured(on, &Build::default()) else { return };
        golden().upload(&mut bench);
        let Request::Commit(commit) = golden().commit(1, 0) else { unreachable!() };
        bench.done(&Request::Commit(Commit { shape, ..commit }));
        let first = frame(&mut bench, 0);
        assert_eq!(made(&bench.receive(&first)), frame_of(1, GOLDEN), "{shape:?}");
    }
}

pub(crate) fn frames_back_to_back_change_between_grids_and_row_factors(on: &dyn Boards) {
    let Some(mut bench) = configured(on, &Build::default()) else { return };
    let unchanged = TableSet::unstretched(2);
    let mut before: Option<(u8, [u32; 2])> = None;
    let sets =
        [(drawn(), DRAWN), (golden(), GOLDEN), (drawn(), DRAWN), (alike(), GOLDEN), (unchanged, UNCHANGED)];
    for (generation, (tables, rows)) in (1_u8..).zip(sets) {
        tables.upload(&mut bench);
        let first_frame = 2 * generation - 2;
        bench.done(&tables.commit(generation, first_frame.into()));
        let (mut packets, mut expected) = (Vec::new(), Vec::new());
        // The previous frame has yet to leave when row 0 of this one enters.
        if let Some((generation, rows)) = before {
            packets.extend(frame(&mut bench, u32::from(first_frame) - 1));
            expected.extend(frame_of(generation, rows));
        }
        packets.extend(frame(&mut bench, first_frame.into()));
        expected.extend(frame_of(generation, rows));
        assert_eq!(made(&bench.receive(&packets)), expected, "generation {generation}");
        bench.acknowledge(2 * (u32::from(first_frame) + 1));
        before = Some((generation, rows));
    }
}

pub(crate) fn with_one_bank_a_grid_takes_effect_at_once(on: &dyn Boards) {
    let Some(mut bench) = configured(on, &lean()) else { return };
    for (generation, (tables, rows)) in
        (1_u8..).zip([(drawn(), DRAWN), (golden(), GOLDEN), (alike(), GOLDEN)])
    {
        tables.upload(&mut bench);
        bench.done(&tables.commit(generation, 40_000));
        let packets = frame(&mut bench, u32::from(generation) - 1);
        assert_eq!(made(&bench.receive(&packets)), frame_of(generation, rows));
        bench.acknowledge(2 * u32::from(generation));
    }
}
