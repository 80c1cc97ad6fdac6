//! Golden values from programs outside the project. When one of these fails, do not change the test: the arithmetic has
//! changed, and every board in the field would disagree.

use crate::row_factor;
use crate::scenes::{frame, golden_samples};
use halfrow_model::{
    BitDepth, Equidistant, Frame, Geometry, Interpolant, Kernel, Phase, TableSet, correct, correct_row,
};

/// DATAPATH.md, "Golden values": one row of 64 samples, C = 63, Q = 14648488.
const HERMITE_ROW: [u16; 64] = [
    1938, 356, 2717, 1150, 3620, 2600, 1707, 2388, 1715, 2078, 1454, 432, 2901, 1378, 3607, 1945, 497, 2939,
    1338, 3808, 2772, 1621, 2637, 1949, 1971, 1662, 619, 3089, 1621, 3657, 1989, 686, 3147, 1845, 176, 2213,
    744, 3215, 2171, 1863, 1884, 807, 3277, 1870, 3667, 2065, 894, 3337, 1888, 226, 2456, 932, 3402, 2379,
    1756, 2118, 995, 3465, 2123, 3644, 2171, 1116, 3478, 1895,
];

const KEYS_ROW: [u16; 64] = [
    1931, 464, 2776, 1089, 3910, 1995, 1820, 3119, 952, 2005, 2057, 131, 2989, 1276, 3450, 2119, 530, 2964,
    1302, 4074, 2182, 1772, 3322, 1166, 1947, 2245, 317, 3208, 1464, 3470, 2325, 621, 3212, 1509, 363, 2370,
    625, 3517, 1588, 1887, 2432, 512, 3429, 1652, 3470, 2532, 731, 3304, 1710, 382, 2558, 844, 3703, 1776,
    1829, 2620, 715, 3650, 1839, 3453, 2745, 857, 3370, 1902,
];

fn full_frame() -> (TableSet, Frame) {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    let tables = TableSet::from_lens(Geometry::default(), &lens, None).unwrap();
    let frame = frame(tables.geometry(), golden_samples(tables.geometry()));
    (tables, frame)
}

fn crc32_of_samples(samples: &[u16]) -> u32 {
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    crc32fast::hash(&bytes)
}

/// A kernel with weights of all sizes and signs, up to the limits: ((5 · node + tap) · 2654435761 mod 2^32 >> 16) − 32768.
fn wild_kernel() -> Kernel {
    let weight = |index: usize| ((index as u32).wrapping_mul(2_654_435_761) >> 16) as u16 ^ 0x8000;
    let node = |node: usize| std::array::from_fn(|tap| weight(5 * node + tap) as i16);
    Kernel::from_nodes((0..65).map(node).collect()).unwrap()
}

#[test]
fn a_row_is_corrected_to_the_golden_values() {
    let geometry = Geometry::centred(64, 1, BitDepth::Twelve).unwrap();
    let row = golden_samples(&geometry);
    for (interpolant, expected) in [(Interpolant::Hermite, HERMITE_ROW), (Interpolant::Keys, KEYS_ROW)] {
        let mut output = [0; 64];
        correct_row(&geometry, row_factor(14_648_488), &interpolant.into(), &row, &mut output);
        assert_eq!(output, expected, "{interpolant}");
    }
}

#[test]
fn the_full_frames_table_is_the_golden_one() {
    let (tables, _) = full_frame();
    assert_eq!([0, 539].map(|row| tables.row_factor(row).unwrap().get()), [14_648_698, 16_777_214]);
    assert_eq!(crc32fast::hash(&tables.to_bytes()), 0x5f5a_7553);
}

#[test]
fn the_kernels_are_the_golden_ones() {
    assert_eq!(crc32fast::hash(&Kernel::from(Interpolant::Hermite).to_bytes()), 0x16e2_9b0f);
    assert_eq!(crc32fast::hash(&Kernel::from(Interpolant::Keys).to_bytes()), 0x54f5_e990);
}

#[test]
fn the_full_frame_is_corrected_to_the_golden_one() {
    let (tables, frame) = full_frame();
    for (interpolant, expected) in [(Interpolant::Hermite, 0x3ecf_6d03), (Interpolant::Keys, 0xd55e_261f)] {
        let corrected = correct(&tables, &interpolant.into(), &frame).unwrap();
        assert_eq!(crc32_of_samples(corrected.samples()), expected, "{interpolant}");
    }
}

/// Corners of the arithmetic, computed by a Python program written from DATAPATH.md: centres at and off the edges, extreme row
/// factors, the smaller depths, and weights up to the limits.
#[test]
fn the_corners_of_the_datapath_agree_with_a_second_program() {
    let [keys, linear, hermite] =
        [Interpolant::Keys, Interpolant::Linear, Interpolant::Hermite].map(Kernel::from);
    let wild = wild_kernel();
    let corners = [
        (BitDepth::Twelve, 0, 1, &keys, 0x2ce1_7723),
        (BitDepth::Twelve, 126, 16_777_215, &keys, 0xe38d_756b),
        (BitDepth::Twelve, 17, 12_345_678, &wild, 0xf844_88c9),
        (BitDepth::Ten, 100, 9_000_001, &hermite, 0x06f1_c28b),
        (BitDepth::Eight, 63, 8_388_608, &wild, 0x741a_394d),
        (BitDepth::Twelve, 63, 1, &linear, 0x0daa_9274),
        (BitDepth::Twelve, 126, 8_255_472, &wild, 0xdde4_2372),
    ];
    for (depth, centre2, factor, kernel, expected) in corners {
        let geometry = Geometry::new(64, 1, depth, centre2).unwrap();
        let samples = golden_samples(&geometry).iter().map(|sample| sample >> (12 - depth.bits())).collect();
        let frame = Frame::new(64, depth, Phase::Bggr, samples).unwrap();
        let tables = TableSet::from_units(geometry, &[factor]).unwrap();
        let corrected = correct(&tables, kernel, &frame).unwrap();
        assert_eq!(crc32_of_samples(corrected.samples()), expected, "C = {centre2}, Q = {factor}");
    }
}
