//! The built-in frames: that each one is what it promises.

use std::collections::HashSet;

use halfrow_frames::{Builtin, Scene};
use halfrow_model::{BitDepth, Equidistant, Frame, Geometry, Phase, TableSet, source};

fn scene(width: usize, height: usize, depth: BitDepth) -> Scene {
    Scene { geometry: Geometry::centred(width, height, depth).unwrap(), ..Scene::default() }
}

fn render(frame: Builtin, scene: &Scene) -> Frame {
    frame.render(scene).unwrap()
}

#[test]
fn every_name_is_read_back_and_described() {
    let descriptions: HashSet<&str> = Builtin::ALL.iter().map(|frame| frame.description()).collect();
    assert_eq!(descriptions.len(), Builtin::ALL.len());
    for frame in Builtin::ALL {
        assert_eq!(frame.to_string().to_uppercase().parse(), Ok(frame));
    }
    let error = "stret".parse::<Builtin>().unwrap_err().to_string();
    assert!(error.starts_with("`stret` is no built-in frame; use one of black, white,"), "{error}");
}

#[test]
fn every_frame_fits_the_smallest_and_the_longest_sizes() {
    for (width, height) in [(64, 1), (66, 3), (2592, 2), (64, 2048)] {
        for (depth, phase) in BitDepth::ALL.into_iter().zip([Phase::Rggb, Phase::Bggr, Phase::Gbrg]) {
            let scene = Scene { phase, ..scene(width, height, depth) };
            for builtin in Builtin::ALL {
                let frame = render(builtin, &scene);
                let found = (frame.width(), frame.height(), frame.depth(), frame.phase());
                assert_eq!(found, (width, height, depth, phase), "{builtin}");
            }
        }
    }
}

#[test]
fn a_seed_decides_the_random_frames_and_nothing_else() {
    let (first, second) = (scene(128, 40, BitDepth::Ten), Scene { seed: 1, ..scene(128, 40, BitDepth::Ten) });
    for builtin in Builtin::ALL {
        let frame = render(builtin, &first);
        assert_eq!(frame, render(builtin, &first), "{builtin}");
        let random = matches!(builtin, Builtin::Noise | Builtin::Extremes | Builtin::Street);
        assert_eq!(frame != render(builtin, &second), random, "{builtin}");
    }
}

#[test]
fn flat_frames_are_at_the_ends_and_the_middle() {
    for (builtin, level) in [(Builtin::Black, 0), (Builtin::White, 1023), (Builtin::Grey, 512)] {
        assert!(
            render(builtin, &scene(64, 2, BitDepth::Ten)).samples().iter().all(|&sample| sample == level)
        );
    }
}

/// Expected values from exact fractions in Python.
#[test]
fn ramps_go_from_end_to_end_rounded_half_up() {
    let small = render(Builtin::RampAcross, &scene(64, 2, BitDepth::Eight));
    let at = |frame: &Frame, columns: &[usize]| columns.iter().map(|&column| frame.row(1)[column]).collect();
    let found: Vec<u16> = at(&small, &[0, 1, 10, 31, 32, 63]);
    assert_eq!(found, [0, 4, 40, 125, 130, 255]);
    let large = render(Builtin::RampAcross, &scene(1920, 2, BitDepth::Twelve));
    let found: Vec<u16> = at(&large, &[0, 1, 2, 959, 960, 1918, 1919]);
    assert_eq!(found, [0, 2, 4, 2046, 2049, 4093, 4095]);
    let down = render(Builtin::RampDown, &scene(64, 64, BitDepth::Eight));
    let found: Vec<u16> = [0, 1, 10, 31, 32, 63].iter().map(|&row| down.row(row)[5]).collect();
    assert_eq!(found, [0, 4, 40, 125, 130, 255]);
}

#[test]
fn bars_have_their_colours_in_every_phase() {
    // Which of the bars white, yellow, cyan, green, magenta, red, blue and black contain red, green and blue.
    let (red, green, blue) = ("11001100", "11110000", "10101010");
    for phase in Phase::ALL {
        let frame = render(Builtin::Bars, &Scene { phase, ..scene(64, 2, BitDepth::Eight) });
        let colours = phase.name().chars().map(|name| match name {
            'r' => red,
            'g' => green,
            _ => blue,
        });
        for ((row, column), bars) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().zip(colours) {
            let found: String =
                (0..8).map(|bar| if frame.row(row)[8 * bar + column] == 255 { '1' } else { '0' }).collect();
            assert_eq!(found, bars, "{phase}, row {row}, column {column}");
        }
    }
}

#[test]
fn neighbours_of_one_colour_alternate_in_the_checkerboard() {
    let frame = render(Builtin::Checkerboard, &scene(64, 8, BitDepth::Twelve));
    for row in frame.rows() {
        assert!(row.windows(3).all(|samples| samples[0].abs_diff(samples[2]) == 4095));
    }
    for column in 0..64 {
        assert!((0..6).all(|row| frame.row(row)[column].abs_diff(frame.row(row + 2)[column]) == 4095));
    }
}

/// Each weight shows by itself: no output has more than one impulse under its seven taps, and over the frame every tap meets an
/// impulse of either kind in every interval of the kernel.
#[test]
fn impulses_meet_every_tap_in_every_interval_of_the_kernel() {
    let scene = Scene::default();
    let frame = render(Builtin::Impulses, &scene);
    let tables = TableSet::from_lens(scene.geometry, &Equidistant::default(), None).unwrap();
    let mut met = HashSet::new();
    for (index, row) in frame.rows().enumerate() {
        let row_factor = tables.row_factor(index).unwrap();
        let rare = if index % 2 == 0 { 4095 } else { 0 };
        for column in 4..row.len() - 4 {
            let source = source(&scene.geometry, row_factor, column);
            let taps = (0..7).map(|tap| row[scene.geometry.sample_column(source.base - 2 + tap)]);
            let hits: Vec<usize> =
                (0..7).zip(taps).filter(|(_, sample)| *sample == rare).map(|hit| hit.0).collect();
            assert!(hits.len() <= 1, "row {index}, column {column} has {hits:?}");
            met.extend(hits.iter().map(|tap| (*tap, source.node, rare)));
        }
    }
    assert_eq!(met.len(), 7 * 64 * 2);
}

#[test]
fn impulses_visit_every_column_both_ways() {
    let frame = render(Builtin::Impulses, &scene(66, 16, BitDepth::Eight));
    for column in 0..66 {
        let bright = (0..16).step_by(2).filter(|&row| frame.row(row)[column] == 255).count();
        let dark = (1..16).step_by(2).filter(|&row| frame.row(row)[column] == 0).count();
        assert_eq!((bright, dark), (1, 1), "column {column}");
    }
}

/// The numbers that the PCG library's own demonstration prints for seed 42 and stream 54; samples are their upper bits.
#[test]
fn noise_is_the_published_sequence_of_its_generator() {
    let published = [0xa15c_02b7_u32, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e];
    for depth in BitDepth::ALL {
        let frame = render(Builtin::Noise, &Scene { seed: 42, ..scene(64, 1, depth) });
        let expected = published.map(|number| number >> (32 - depth.bits()));
        assert_eq!(frame.row(0)[..6].iter().map(|&sample| u32::from(sample)).collect::<Vec<_>>(), expected);
    }
}

/// Halfway between two samples of one colour, Hermite is (G2 + G4)/2 + (2·R3 − R1 − R5)/8 and Keys is
/// (9·G2 + 9·G4 − G0 − G6)/16 (Eqs. 12 and 18 at x = 1).
#[test]
fn extremes_drive_either_sum_beyond_both_ends_in_either_colour() {
    let max = 1023.0;
    let frame = render(Builtin::Extremes, &scene(64, 8, BitDepth::Ten));
    let mut beyond = HashSet::new();
    for row in frame.rows() {
        for (first, taps) in row.windows(7).enumerate() {
            let [g0, r1, g2, r3, g4, r5, g6] = std::array::from_fn(|tap| f64::from(taps[tap]));
            let hermite = (g2 + g4) / 2.0 + (2.0 * r3 - r1 - r5) / 8.0;
            let keys = (9.0 * g2 + 9.0 * g4 - g0 - g6) / 16.0;
            for (kernel, sum) in [("hermite", hermite), ("keys", keys)] {
                if !(0.0..=max).contains(&sum) {
                    beyond.insert((kernel, sum > max, first % 2));
                }
            }
        }
    }
    assert_eq!(beyond.len(), 8, "{beyond:?}");
    assert!(frame.samples().iter().all(|&sample| sample == 0 || sample == 1023));
}

/// floor((1/2 + cos(2π · r²/4W)/2) · 4095 + 1/2), by Python's mathematics library.
#[test]
fn the_zone_plate_follows_its_formula() {
    let frame = render(Builtin::ZonePlate, &Scene::default());
    let samples = [(959, 539, 4095), (0, 0, 2349), (1919, 1079, 2349), (100, 700, 79), (1500, 20, 2922)];
    for (column, row, sample) in samples.into_iter().chain([(7, 539, 3427), (1234, 567, 3774)]) {
        assert_eq!(frame.row(row)[column], sample, "row {row}, column {column}");
    }
}
