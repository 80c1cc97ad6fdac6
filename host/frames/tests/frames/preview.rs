//! Previews: development into pictures for the screen.

use halfrow_frames::preview::{RgbImage, demosaic, demosaic_coded, encode_png_rgb, thumbnail};
use halfrow_frames::{Builtin, DecodeError, Scene};
use halfrow_model::{BitDepth, Colour, Frame, Geometry, Phase};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

fn frame(width: usize, phase: Phase, samples: &[u16]) -> Frame {
    Frame::new(width, BitDepth::Eight, phase, samples.to_vec()).unwrap()
}

/// sRGB by IEC 61966-2-1, computed in Python: 0.5 is coded as 188, 0.2 as 124, 1/255 as 13.
#[test]
fn linear_samples_are_coded_for_the_screen() {
    let levels = [(0, 0), (1, 13), (51, 124), (128, 188), (255, 255)];
    for (sample, byte) in levels {
        let image = demosaic(&frame(2, Phase::Grbg, &[sample; 4]));
        assert_eq!((image.width, image.height), (2, 2));
        assert_eq!(image.data, [byte; 12], "{sample}");
    }
}

/// By hand: 2048 · 255/4095 is 127.5, and 2047 gives just less; 514 · 255/1023 is 128.1.
#[test]
fn coded_samples_are_brought_to_eight_bits() {
    let levels =
        [(BitDepth::Twelve, 2048, 128), (BitDepth::Twelve, 2047, 127), (BitDepth::Twelve, 4095, 255)];
    for (depth, sample, byte) in
        levels.into_iter().chain([(BitDepth::Ten, 514, 128), (BitDepth::Eight, 77, 77)])
    {
        let frame = Frame::new(2, depth, Phase::Grbg, vec![sample; 4]).unwrap();
        assert_eq!(demosaic_coded(&frame).data, [byte; 12], "{sample}");
    }
}

/// Computed by hand: at the red place, green is the mean of the four greens next to it, and blue that of the four blues at its
/// corners.
#[test]
fn a_missing_colour_is_the_mean_of_its_neighbours() {
    let samples = [
        10, 20, 30, 40, //
        50, 255, 51, 60, //
        90, 0, 250, 70, //
        80, 2, 81, 1,
    ];
    // BGGR: row 0 is b g b g, row 1 is g r g r.
    let image = demosaic(&frame(4, Phase::Bggr, &samples));
    let coded = |sample: u16| demosaic(&frame(2, Phase::Grbg, &[sample; 4])).data[0];
    let pixel = |row: usize, column: usize| image.data[(row * 4 + column) * 3..][..3].to_vec();
    // Greens 20, 50, 51, 0: 30.25; blues 10, 30, 90, 250: 95.
    assert_eq!(pixel(1, 1), [coded(255), coded(30), coded(95)]);
    // At the blue corner: one red, two greens: 35.
    assert_eq!(pixel(0, 0), [coded(255), coded(35), coded(10)]);
    // At the green place of a red row: reds 255 and 60, 157.5 rounds up; blues 30 and 250.
    assert_eq!(pixel(1, 2), [coded(158), coded(51), coded(140)]);
}

/// The colour `wanted` at one place, directly by the definition.
fn mean_of_neighbours(frame: &Frame, (row, column): (usize, usize), wanted: Colour) -> u8 {
    let colour = |row, column| frame.phase().colour(row, column);
    if colour(row, column) == wanted {
        return frame.row(row)[column] as u8;
    }
    let near = |place: usize, end: usize| (0..end).filter(move |other| place.abs_diff(*other) <= 1);
    let samples: Vec<u32> = near(row, frame.height())
        .flat_map(|y| near(column, frame.width()).map(move |x| (y, x)))
        .filter(|&(y, x)| colour(y, x) == wanted)
        .map(|(y, x)| frame.row(y)[x].into())
        .collect();
    let mean = f64::from(samples.iter().sum::<u32>()) / samples.len().max(1) as f64;
    (mean + 0.5) as u8
}

proptest! {
    #[test]
    fn every_place_of_every_frame_has_the_means_of_its_neighbours(
        (width, samples) in (1_usize..5, 1_usize..6).prop_flat_map(|(pairs, height)| {
            (Just(2 * pairs), vec(0_u16..256, 2 * pairs * height))
        }),
        phase in select(&Phase::ALL),
    ) {
        let frame = frame(width, phase, &samples);
        let image = demosaic_coded(&frame);
        let places = (0..frame.height()).flat_map(|row| (0..width).map(move |column| (row, column)));
        let colours = [Colour::Red, Colour::Green, Colour::Blue];
        let expected: Vec<u8> = places
            .flat_map(|place| colours.map(|colour| mean_of_neighbours(&frame, place, colour)))
            .collect();
        prop_assert_eq!(image.data, expected);
    }
}

#[test]
fn a_colour_that_a_single_row_lacks_is_black() {
    assert_eq!(demosaic(&frame(2, Phase::Grbg, &[255, 51])).data, [124, 255, 0, 124, 255, 0]);
}

#[test]
fn bars_come_out_in_their_colours_in_every_phase() {
    for phase in Phase::ALL {
        let geometry = Geometry::centred(64, 4, BitDepth::Twelve).unwrap();
        let image = demosaic(&Builtin::Bars.render(&Scene { geometry, phase, ..Scene::default() }).unwrap());
        let middle = |bar: usize| image.data[(64 + bar * 8 + 4) * 3..][..3].to_vec();
        assert_eq!(middle(1), [255, 255, 0], "{phase}");
        assert_eq!(middle(2), [0, 255, 255], "{phase}");
        assert_eq!(middle(5), [255, 0, 0], "{phase}");
        assert_eq!(middle(6), [0, 0, 255], "{phase}");
    }
}

#[test]
fn a_thumbnail_averages_light_and_keeps_within_its_width() {
    let geometry = Geometry::centred(64, 6, BitDepth::Eight).unwrap();
    let scene = Scene { geometry, ..Scene::default() };
    let board = Builtin::Checkerboard.render(&scene).unwrap();
    let image = thumbnail(&board, 16);
    assert_eq!((image.width, image.height, image.data.len()), (16, 2, 96));
    let ramp = thumbnail(&Builtin::RampAcross.render(&scene).unwrap(), 20);
    assert_eq!((ramp.width, ramp.height), (16, 2));
    assert!(ramp.data.chunks(3).take(16).is_sorted_by_key(|pixel| pixel[1]));
    // Half of the samples are at full light: 0.5 is coded as 188 (127.5 of 255 rounds to 128).
    assert!(image.data[3..15].iter().all(|byte| (180..=196).contains(byte)), "{:?}", image.data);
    assert_eq!(thumbnail(&board, 0).width, 1);
    assert_eq!(thumbnail(&board, 1000), demosaic(&board));
}

#[test]
fn pictures_survive_as_png() {
    let geometry = Geometry::centred(64, 6, BitDepth::Eight).unwrap();
    let image = demosaic(&Builtin::Bars.render(&Scene { geometry, ..Scene::default() }).unwrap());
    let mut file = Vec::new();
    encode_png_rgb(&image, &mut file).unwrap();
    assert_eq!(pixels(&file), (64, 6, image.data));
    let short = RgbImage { width: 4, height: 3, data: vec![0; 35] };
    assert!(encode_png_rgb(&short, &mut Vec::new()).is_err());
}

#[test]
fn a_picture_larger_than_any_png_is_refused() {
    for (width, height) in [(1 << 40, 1 << 40), (1 << 32, 1), (usize::MAX, 2)] {
        let image = RgbImage { width, height, data: vec![0; 3] };
        assert!(encode_png_rgb(&image, &mut Vec::new()).is_err(), "{width} x {height}");
    }
}

#[test]
fn a_picture_has_three_bytes_a_pixel() {
    let new = |width, height, bytes| RgbImage::new(width, height, vec![7; bytes]);
    assert_eq!(new(2, 3, 18).unwrap(), RgbImage { width: 2, height: 3, data: vec![7; 18] });
    assert!(matches!(new(0, 3, 0), Err(DecodeError::Empty)));
    assert!(matches!(new(2, 3, 17), Err(DecodeError::Truncated { expected: 18, found: 17 })));
    assert!(matches!(new(2, 3, 20), Err(DecodeError::Trailing { extra: 2, .. })));
    assert!(matches!(new(1 << 40, 1 << 40, 3), Err(DecodeError::TooLarge { .. })));
}

fn pixels(file: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    (info.width, info.height, data)
}
