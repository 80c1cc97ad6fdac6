//! The golden values of AT-SPEED.md, computed outside the project, and the fast content against the one that is written for
//! clarity. When a golden value fails, do not change the test: every board in the field would disagree.

use halfrow_model::{
    BitDepth, Content, Corrector, Equidistant, Frame, Geometry, Interpolant, Kernel, MAX_WIDTH, Phase,
    Signer, TableSet, correct, frame_signature, row_signature,
};
use proptest::prelude::*;

use crate::fast::paths;

/// The first samples, the CRC-32 of all 64 and the signature of each row of seed 1, frame 0.
const ROWS: [([u16; 12], u32, u32); 4] = [
    ([4095, 0, 4095, 4095, 0, 4095, 4095, 0, 0, 0, 4095, 0], 0x3f30_8f73, 0x3b58_4a0c),
    ([2192, 2729, 3419, 1675, 316, 2892, 2077, 1755, 4021, 3317, 2157, 4039], 0x1470_85ad, 0xa0a8_5d70),
    ([2128, 2128, 2128, 2128, 2128, 2128, 2128, 2128, 64, 64, 64, 64], 0x4de3_0b33, 0x068e_af3c),
    ([0, 4095, 0, 4095, 0, 4095, 0, 4095, 0, 4095, 0, 4095], 0x4f53_a7e2, 0x4f53_a7e2),
];

/// The signature of a frame of those four rows.
const FRAME_OF_ROWS: u32 = 0xc40b_35b2;

/// A frame corrected with the table of R = 1106.697: the CRC-32 of its samples, if the page has it, and its signature.
struct Golden {
    content: Content,
    geometry: Geometry,
    kernel: Interpolant,
    samples: Option<u32>,
    signature: u32,
}

fn golden_frames() -> [Golden; 4] {
    let geometry = |width, height, depth, centre2| Geometry::new(width, height, depth, centre2).unwrap();
    let full = geometry(1920, 1080, BitDepth::Twelve, 1919);
    let golden = |seed, frame, geometry, kernel, samples, signature| Golden {
        content: Content { seed, frame },
        geometry,
        kernel,
        samples,
        signature,
    };
    let ten = geometry(64, 16, BitDepth::Ten, 100);
    let eight = geometry(66, 33, BitDepth::Eight, 0);
    [
        golden(0xffff_ffff, 65535, ten, Interpolant::Keys, Some(0xa1de_c90f), 0xe20a_ee2d),
        golden(0x1234_5678, 1, eight, Interpolant::Hermite, Some(0x9705_d11d), 0xf4d5_c8b9),
        golden(1, 0, full, Interpolant::Hermite, Some(0x406e_3c55), 0xfedd_7f90),
        golden(1, 1, full, Interpolant::Keys, None, 0x9b2e_415a),
    ]
}

/// The signatures of the rows that the oracles give for a frame.
fn rows_of(content: Content, tables: &TableSet, kernel: &Kernel) -> Vec<u32> {
    let (width, depth) = (tables.geometry().width(), tables.geometry().depth());
    let mut samples = vec![0; width * tables.geometry().height()];
    for (row, samples) in samples.chunks_exact_mut(width).enumerate() {
        content.row(row, depth, samples);
    }
    let frame = Frame::new(width, depth, Phase::Grbg, samples).unwrap();
    correct(tables, kernel, &frame).unwrap().rows().map(row_signature).collect()
}

#[test]
fn rows_are_the_golden_ones() {
    let content = Content { seed: 1, frame: 0 };
    let geometry = Geometry::new(64, 4, BitDepth::Twelve, 63).unwrap();
    let tables = TableSet::from_units(geometry, &[14_648_488; 4]).unwrap();
    let signed = rows_of(content, &tables, &Interpolant::Hermite.into());
    for (row, (first, crc, signature)) in ROWS.into_iter().enumerate() {
        let mut samples = [0; 64];
        content.row(row, BitDepth::Twelve, &mut samples);
        assert_eq!((&samples[..12], row_signature(&samples)), (&first[..], crc), "row {row}");
        assert_eq!(signed[row], signature, "row {row}");
    }
    assert_eq!(frame_signature(&signed), FRAME_OF_ROWS);
}

#[test]
fn frames_are_the_golden_ones_by_every_path() {
    let lens = Equidistant::from_radius(1106.697).unwrap();
    for (number, golden) in golden_frames().into_iter().enumerate() {
        let tables = TableSet::from_lens(golden.geometry, &lens, None).unwrap();
        let kernel = Kernel::from(golden.kernel);
        if let Some(samples) = golden.samples {
            let frame = golden.content.frame(&golden.geometry, Phase::Grbg);
            assert_eq!(row_signature(frame.samples()), samples, "frame {number}");
        }
        let oracle = rows_of(golden.content, &tables, &kernel);
        assert_eq!(frame_signature(&oracle), golden.signature, "frame {number}");
        for path in paths() {
            let mut signer = Signer::new(Corrector::new(path, &kernel).unwrap());
            let mut rows = Vec::new();
            assert_eq!(
                signer.sign(&tables, golden.content, &mut rows),
                golden.signature,
                "frame {number}, {path}"
            );
            assert_eq!(rows, oracle, "frame {number}, {path}");
        }
    }
}

proptest! {
    #[test]
    fn rows_made_together_are_those_made_one_by_one(
        seed in any::<u32>(), frame in any::<u16>(), half in 32..=MAX_WIDTH / 2, height in 1..=90_usize,
        depth in prop::sample::select(BitDepth::ALL.to_vec()),
    ) {
        let geometry = Geometry::centred(2 * half, height, depth).unwrap();
        let content = Content { seed, frame };
        let found = content.frame(&geometry, Phase::Grbg);
        let mut expected = vec![0; geometry.width()];
        for (row, samples) in found.rows().enumerate() {
            content.row(row, depth, &mut expected);
            prop_assert_eq!(samples, &expected[..], "row {}", row);
        }
    }

    #[test]
    fn a_signer_goes_on_with_other_frames(
        frames in prop::collection::vec((any::<u32>(), any::<u16>(), 32..=150_usize, 1..=150_usize), 2),
        mirrored in any::<bool>(), path in prop::sample::select(paths().collect::<Vec<_>>()),
        depth in prop::sample::select(BitDepth::ALL.to_vec()),
    ) {
        let kernel = Kernel::from(Interpolant::Keys);
        let mut signer = Signer::new(Corrector::new(path, &kernel).unwrap());
        let mut rows = Vec::new();
        for (seed, frame, half, height) in frames {
            let geometry = Geometry::centred(2 * half, height, depth).unwrap();
            let factor = |row: usize| 9_000_000 + 1000 * if mirrored { row.min(height - 1 - row) } else { row } as u32;
            let tables = TableSet::from_units(geometry, &(0..height).map(factor).collect::<Vec<_>>()).unwrap();
            let content = Content { seed, frame };
            let signature = signer.sign(&tables, content, &mut rows);
            let expected = rows_of(content, &tables, &kernel);
            prop_assert_eq!(signature, frame_signature(&expected));
            prop_assert_eq!(&rows, &expected);
        }
    }
}
