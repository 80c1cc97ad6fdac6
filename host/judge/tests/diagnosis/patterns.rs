//! Faults of lines, and of the kernel's switch, that the mock does not have.

use halfrow::result::Suspect;
use halfrow::tables::Generation;
use halfrow_model::{Frame, correct};

use crate::bench::{Bench, CaseInput, narrow, wide};

/// The suspects for a board that gives `found` of the index of each frame, of what went in and of what should come out.
fn diagnose(bench: &Bench, found: impl Fn(usize, &Frame, &Frame) -> Vec<u16>) -> Vec<Suspect> {
    let mut seen = CaseInput { frames: Vec::new(), evidence: Vec::new() };
    for (index, (generation, input, expected)) in bench.sound_frames().into_iter().enumerate() {
        let found = with(&input, found(index, &input, &expected));
        seen.take(generation, input, expected, found);
    }
    bench.judge(&seen)
}

fn with(frame: &Frame, samples: Vec<u16>) -> Frame {
    Frame::new(frame.width(), frame.depth(), frame.phase(), samples).unwrap()
}

/// The place of the only suspect, which must explain everything.
fn certain(suspects: &[Suspect]) -> String {
    let [only] = suspects else { panic!("{suspects:#?}") };
    assert_eq!(only.explained, 1.0, "{only:#?}");
    only.place()
}

/// The samples with `alter` made of each column and sample.
fn altered(samples: &[u16], width: usize, alter: impl Fn(usize, u16) -> u16) -> Vec<u16> {
    samples.iter().enumerate().map(|(place, &sample)| alter(place % width, sample)).collect()
}

/// The suspect for a board whose corrected samples `alter` changes.
fn behind(alter: impl Fn(usize, u16) -> u16) -> String {
    certain(&diagnose(&narrow(), |_, _, expected| altered(expected.samples(), expected.width(), &alter)))
}

/// The suspect for a board whose samples `alter` changes before they are corrected.
fn before(alter: impl Fn(usize, u16) -> u16) -> String {
    let bench = wide();
    certain(&diagnose(&bench, |index, input, _| {
        let Generation { tables, kernel, .. } = &bench.generations[usize::from(index > 1)];
        let stored = with(input, altered(input.samples(), input.width(), &alter));
        correct(tables, kernel, &stored).unwrap().samples().to_vec()
    }))
}

/// Bits 2 and 9 of a sample exchanged.
fn exchanged(sample: u16) -> u16 {
    sample & !0x204 | (sample >> 2 & 1) << 9 | (sample >> 9 & 1) << 2
}

#[test]
fn lines_that_are_exchanged_are_named() {
    assert_eq!(behind(|_, sample| exchanged(sample)), "corrected samples, bits 2 and 9 exchanged");
    assert_eq!(before(|_, sample| exchanged(sample)), "line memory, bits 2 and 9 exchanged");
}

#[test]
fn a_line_that_is_inverted_is_named() {
    assert_eq!(behind(|_, sample| sample ^ 16), "corrected samples, bit 4 inverted");
    assert_eq!(before(|_, sample| sample ^ 16), "line memory, bit 4 inverted");
}

#[test]
fn lines_that_touch_are_named() {
    let low = |_, sample: u16| if sample & 0x30 == 0x30 { sample } else { sample & !0x30 };
    assert_eq!(behind(low), "corrected samples, bits 4 and 5 connected, where 0 wins");
    let high = |_, sample: u16| if sample & 0x30 == 0 { sample } else { sample | 0x30 };
    assert_eq!(before(high), "line memory, bits 4 and 5 connected, where 1 wins");
}

/// One of two lanes, or one half of a memory.
#[test]
fn a_line_that_is_stuck_in_every_other_column_is_named() {
    let odd = |column: usize, sample: u16| if column % 2 == 1 { sample | 64 } else { sample };
    assert_eq!(behind(odd), "corrected samples, bit 6 stuck at 1 in odd columns alone");
    let even = |column: usize, sample: u16| if column.is_multiple_of(2) { sample & !64 } else { sample };
    assert_eq!(before(even), "line memory, bit 6 stuck at 0 in even columns alone");
}

/// Two samples are three bytes, least significant first: bit 1 of these is bits 1 and 9 of the first sample and bit 5 of the
/// second (WIRE.md, 20).
#[test]
fn a_line_of_the_bytes_of_packed_rows_is_named() {
    let stuck = |column: usize, sample: u16| sample | if column.is_multiple_of(2) { 0x202 } else { 0x20 };
    assert_eq!(behind(stuck), "the bytes of rows on their way out, bit 1 stuck at 1");
    assert_eq!(before(stuck), "the bytes of rows on their way in, bit 1 stuck at 1");
}

/// The suspects for a board that makes `row` of `frame` with the kernel of the first of these generations up to the middle, and
/// with that of the second from there on.
fn switched(row: usize, frame: usize, generations: [usize; 2]) -> Vec<Suspect> {
    let bench = wide();
    diagnose(&bench, |index, input, expected| {
        let mut samples = expected.samples().to_vec();
        if index == frame {
            let tables = &bench.generations[usize::from(index > 1)].tables;
            let made = |kernel: usize| correct(tables, &bench.generations[kernel].kernel, input).unwrap();
            let [left, right] = generations.map(made);
            let (from, half) = (row * input.width(), input.width() / 2);
            samples[from..][..half].copy_from_slice(&left.row(row)[..half]);
            samples[from + half..][..half].copy_from_slice(&right.row(row)[half..]);
        }
        samples
    })
}

#[test]
fn a_kernel_that_is_not_kept_to_the_end_of_a_row_is_named() {
    let suspects = switched(23, 1, [0, 1]);
    assert_eq!(certain(&suspects), "the switch of the kernel's bank, within row 23 of frame 1");
    let evidence = suspects[0].evidence();
    assert!(evidence.contains("the kernel of generation 1 up to"), "{evidence}");
    assert!(evidence.contains("that of generation 2 from there on"), "{evidence}");
}

#[test]
fn a_kernel_that_comes_late_within_a_row_is_named() {
    let suspects = switched(0, 2, [0, 1]);
    assert_eq!(certain(&suspects), "the switch of the kernel's bank, within row 0 of frame 2");
}

/// Where nothing is named, what the differences have in common is what to look at.
#[test]
fn what_differences_have_in_common_is_where_to_look() {
    let wrong = |is_meant: fn(usize) -> bool| {
        let suspects =
            diagnose(&narrow(), move |_, _, expected| {
                altered(expected.samples(), expected.width(), |column, sample| {
                    if is_meant(column) { sample / 3 } else { sample }
                })
            });
        assert_eq!(suspects[0].part(), "unknown", "{suspects:#?}");
        suspects[0].designer()
    };
    assert!(wrong(|column| column == 127).starts_with("Check what only column 127 meets"));
    assert!(wrong(|column| column % 2 == 1).starts_with("Check what only odd columns use"));
    assert!(wrong(|_| true).starts_with("Look at the difference maps"));
}
