//! Values that were computed by a program outside the project.

use halfrow_mock::{Depth, Kernel, Options, Player, RowOut, Settings, Tables, UNSTRETCHED};

use crate::support::{
    GOLDEN_FACTOR, binding, core, crc_of_words, factors, hermite, keys, noise_row, play_frame, row_out, run,
    unchanged,
};
use halfrow_conformance::golden_rows::{HERMITE, KEYS};

const RADIUS: f64 = 1106.697;

fn crc_of_kernel(kernel: &Kernel) -> u32 {
    let words = kernel.nodes.iter().flat_map(|n| [n.g0, n.r1, n.g4, n.r5, n.g6]);
    crc_of_words(words.map(i16::cast_unsigned))
}

#[test]
fn the_tests_own_tables_are_the_golden_ones() {
    let factors = factors(1080, RADIUS);
    let bytes: Vec<u8> = factors.iter().flat_map(|factor| factor.to_le_bytes()).collect();
    assert_eq!((factors[0], factors[539]), (14_648_698, 16_777_214));
    assert_eq!(crc32fast::hash(&bytes), 0x5f5a_7553);
    assert_eq!(crc_of_kernel(&hermite()), 0x16e2_9b0f);
    assert_eq!(crc_of_kernel(&keys()), 0x54f5_e990);
}

#[test]
fn a_golden_row_comes_out_with_hermite() {
    let row = (noise_row(0, 64), binding(64, GOLDEN_FACTOR, hermite()));
    assert_eq!(row_out(&run(&mut core(12, 64, None), &[row], 0), 64, 0), HERMITE);
}

#[test]
fn a_golden_row_comes_out_with_keys() {
    let row = (noise_row(0, 64), binding(64, GOLDEN_FACTOR, keys()));
    assert_eq!(row_out(&run(&mut core(12, 64, None), &[row], 0), 64, 0), KEYS);
}

#[test]
fn rows_with_other_factors_and_kernels_share_the_ring_without_blanking() {
    let samples = noise_row(0, 64);
    let rows = [
        (samples.clone(), binding(64, GOLDEN_FACTOR, hermite())),
        (noise_row(7, 64), unchanged(64)),
        (samples.clone(), binding(64, GOLDEN_FACTOR, keys())),
        (noise_row(9, 64), binding(64, UNSTRETCHED, keys())),
        (samples, binding(64, GOLDEN_FACTOR, hermite())),
    ];
    for ring in [64, 128, 2048] {
        let outputs = run(&mut core(12, ring, None), &rows, 0);
        let expected =
            [HERMITE.to_vec(), noise_row(7, 64), KEYS.to_vec(), noise_row(9, 64), HERMITE.to_vec()];
        for (index, expected) in expected.iter().enumerate() {
            assert_eq!(&row_out(&outputs, 64, index), expected, "row {index}, ring {ring}");
        }
    }
}

/// The golden frame, played with this blanking and these gaps.
fn golden_frame(kernel: &Kernel, blanking: u16, gap_seed: u32) -> Vec<RowOut> {
    let options = Options::default();
    let mut player = Player::new(&options, None).unwrap();
    let mut tables = Tables::new(&options, None);
    let depth = Depth::Twelve;
    player
        .configure(Settings { width: 1920, height: 1080, centre2: 1919, depth, blanking, gap_seed })
        .unwrap();
    tables.write_factors(0, &factors(1080, RADIUS)).unwrap();
    tables.write_nodes(0, &kernel.nodes).unwrap();
    tables.commit(1, 0).unwrap();
    play_frame(&mut player, &mut tables, 0)
}

fn crc_of_frame(rows: &[RowOut]) -> u32 {
    crc_of_words(rows.iter().flat_map(|row| row.samples.iter().copied()))
}

#[test]
fn the_golden_frame_comes_out_with_hermite() {
    assert_eq!(crc_of_frame(&golden_frame(&hermite(), 0, 0)), 0x3ecf_6d03);
}

#[test]
fn the_golden_frame_comes_out_with_keys() {
    assert_eq!(crc_of_frame(&golden_frame(&keys(), 0, 0)), 0xd55e_261f);
}

#[test]
fn blanking_and_gaps_change_no_sample_and_no_latency() {
    let rows = golden_frame(&hermite(), 900, 1);
    assert_eq!(crc_of_frame(&rows), 0x3ecf_6d03);
    assert!(rows.iter().all(|row| (row.first_latency, row.last_latency) == (972, 972)));
    assert!(rows.iter().all(|row| row.pauses > 0));
}
