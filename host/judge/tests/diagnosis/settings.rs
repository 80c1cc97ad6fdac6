//! Boards that ignore a setting.

use halfrow::result::Suspect;
use halfrow::tables::Generation;
use halfrow_model::{BitDepth, Frame, Geometry, correct};

use crate::bench::{Bench, CaseInput, off_centre, off_centre_grid};

/// The benches with 8 bits and a centre of their own, and a decoy whose centre is the middle.
fn benches() -> [Bench; 2] {
    [off_centre(), off_centre_grid()].map(|mut bench| {
        let tables = &mut bench.generations[0].tables;
        *tables = tables.with_settings(BitDepth::Eight, 191).unwrap();
        bench
    })
}

/// The suspect for a board that makes each frame, by its index, with the settings that `made` gives.
fn diagnose(bench: &Bench, made: impl Fn(usize, &Geometry) -> Geometry) -> Suspect {
    let mut seen = CaseInput { frames: Vec::new(), evidence: Vec::new() };
    for (index, (generation, input, expected)) in bench.sound_frames().into_iter().enumerate() {
        let Generation { tables, kernel, .. } = &bench.generations[usize::from(generation) - 1];
        let geometry = made(index, tables.geometry());
        let tables = tables.with_settings(geometry.depth(), geometry.centre2()).unwrap();
        let samples = input.samples().to_vec();
        let put_in = Frame::new(input.width(), geometry.depth(), input.phase(), samples).unwrap();
        seen.take(generation, input, expected, correct(&tables, kernel, &put_in).unwrap());
    }
    seen.keep_all(bench.sound_frames());
    let suspects = bench.judge(&seen);
    let [only] = &suspects[..] else { panic!("{suspects:#?}") };
    assert_eq!((only.part(), only.explained), ("setting", 1.0), "{only:#?}");
    only.clone()
}

#[test]
fn a_centre_that_is_half_a_column_off_is_named() {
    for bench in benches() {
        for (halves, place) in [
            (-1, "the optical centre, half a column too far to the left"),
            (1, "the optical centre, half a column too far to the right"),
        ] {
            let off = diagnose(&bench, |_, own| {
                let centre2 = own.centre2().checked_add_signed(halves).unwrap();
                Geometry::new(192, 24, own.depth(), centre2).unwrap()
            });
            assert_eq!(off.place(), place);
        }
    }
}

#[test]
fn a_centre_that_is_not_taken_is_named() {
    for bench in benches() {
        let middle = diagnose(&bench, |_, own| Geometry::centred(192, 24, own.depth()).unwrap());
        assert_eq!(middle.place(), "the setting of the optical centre");
        assert!(
            middle.evidence().starts_with("with the middle of the row taken instead"),
            "{}",
            middle.evidence()
        );
    }
}

/// Frame 2 is the first after the decoy.
#[test]
fn a_centre_that_is_taken_a_frame_late_is_named() {
    for bench in benches() {
        let late = diagnose(&bench, |index, own| match index {
            2 => Geometry::centred(192, 24, own.depth()).unwrap(),
            _ => *own,
        });
        assert_eq!(late.place(), "the setting of the optical centre");
        assert!(late.evidence().starts_with("with that of the frame before kept"), "{}", late.evidence());
    }
}

/// C is 191, 1011 1111, in the decoy and 150, 1001 0110, in the others.
#[test]
fn a_stuck_bit_of_the_centre_is_named() {
    for bench in benches() {
        for (bit, value) in [(1, 0), (3, 0), (4, 0), (3, 1), (6, 1)] {
            let stuck = diagnose(&bench, |_, own| {
                let centre2 = own.centre2() & !(1 << bit) | value << bit;
                Geometry::new(own.width(), own.height(), own.depth(), centre2).unwrap()
            });
            let place = format!("the setting of the optical centre, bit {bit} stuck at {value}");
            assert_eq!(stuck.place(), place);
        }
    }
}

#[test]
fn a_depth_that_is_not_taken_is_named() {
    for bench in benches() {
        let deep = diagnose(&bench, |_, own| {
            Geometry::new(own.width(), own.height(), BitDepth::Twelve, own.centre2()).unwrap()
        });
        assert_eq!(deep.place(), "the setting of the depth");
        assert!(deep.evidence().starts_with("with 12 bits taken instead"), "{}", deep.evidence());
    }
}
