//! Single words of the tables, whose faults a read-back may hide.

use halfrow::result::Suspect;
use halfrow_model::Interpolant;

use crate::bench::{Bench, CaseInput, WHITE, assert_named, fault, is_told, narrow, wide};

#[test]
fn a_bit_of_a_rows_factor_is_named() {
    for row in [0, 3, 7, 8, 15] {
        for bit in 10..24 {
            let place = format!("row {row}'s factor, bit {bit}");
            assert_named(&narrow(), &format!("row-factor,row={row},bit={bit},hidden=true"), &place);
        }
    }
}

#[test]
fn a_bit_of_a_rows_factor_is_named_in_wider_frames() {
    for (row, bit) in [(1, 9), (4, 12), (11, 23), (12, 16), (23, 20)] {
        let place = format!("row {row}'s factor, bit {bit}");
        assert_named(&wide(), &format!("row-factor,row={row},bit={bit}"), &place);
    }
}

/// The factor exceeds 1, and which samples come then is undefined.
#[test]
fn the_highest_bit_of_a_rows_factor_is_named_first() {
    for (bench, row) in [(narrow(), 2), (narrow(), 14), (wide(), 5)] {
        let suspects = bench.diagnose(fault(&format!("row-factor,row={row},bit=24")));
        assert_eq!(suspects[0].place(), format!("row {row}'s factor, bit 24"), "{suspects:#?}");
    }
}

/// Outside the image circle every factor is 1. A flipped bit makes it more, and then part of the row cannot be predicted.
#[test]
fn a_bit_of_a_factor_of_one_is_named_first() {
    for (width, height, radius, row) in [(320, 200, 80.0, 5), (128, 96, 40.0, 5), (64, 15, 20.0, 7)] {
        let bench = Bench::new(width, height, radius, 2048, Interpolant::Hermite);
        for bit in 0..24 {
            let seen = bench.play(Some(fault(&format!("row-factor,row={row},bit={bit},hidden=true"))));
            let suspects = bench.judge(&seen);
            let place = format!("row {row}'s factor, bit {bit}");
            assert_eq!(seen.differences() == 0, suspects.is_empty(), "{width} x {height}, bit {bit}");
            let is_first = suspects.first().is_none_or(|first| first.place() == place);
            assert!(is_first, "{width} x {height}, bit {bit}: {suspects:#?}");
        }
    }
}

/// In a single frame a low bit changes only a few samples, and other bits change the same ones in the same way.
#[test]
fn bits_of_one_word_that_come_to_the_same_are_one_suspect() {
    let bench = Bench::new(64, 16, 40.0, 2048, Interpolant::Hermite);
    let mut several = 0;
    for (row, bit) in (0..16).flat_map(|row| (0..12).map(move |bit| (row, bit))) {
        let mut seen = bench.play(Some(fault(&format!("row-factor,row={row},bit={bit},hidden=true"))));
        seen.evidence.retain(|evidence| evidence.index == 2);
        let suspects = bench.judge(&seen);
        let one_word = |suspect: &&Suspect| suspect.place().contains("one of bits");
        let Some(first) = suspects.first().filter(one_word) else { continue };
        assert!(is_told(first, &format!("row {row}'s factor, bit {bit}")), "bit {bit}: {suspects:#?}");
        let evidence = first.evidence();
        assert!(evidence.starts_with("with any one of these bits inverted"), "{evidence}");
        assert_eq!(evidence.contains("not certain"), suspects.len() > 1, "{suspects:#?}");
        several += 1;
    }
    assert!(several > 0);
}

#[test]
fn a_bit_of_a_kernel_word_is_named() {
    for (node, weight, bit) in [
        (0, "g4", 13),
        (1, "r1", 9),
        (7, "r5", 11),
        (12, "r1", 15),
        (16, "g4", 6),
        (31, "g0", 14),
        (32, "g6", 10),
        (40, "r1", 5),
        (63, "g4", 12),
        (64, "r5", 15),
    ] {
        let place = format!("kernel node {node}, weight {weight}, bit {bit}");
        let text = format!("kernel-word,node={node},weight={weight},bit={bit},hidden=true");
        assert_named(&narrow(), &text, &place);
        assert_named(&wide(), &text, &place);
    }
}

/// Most of the lowest bits change no sample, and those that do often cannot be told apart.
#[test]
fn low_bits_of_a_rows_factor_are_among_the_suspects_or_invisible() {
    for bit in 0..10 {
        let bench = wide();
        let seen = bench.play(Some(fault(&format!("row-factor,row=2,bit={bit}"))));
        let suspects = bench.judge(&seen);
        let place = format!("row 2's factor, bit {bit}");
        assert_eq!(seen.differences() == 0, suspects.is_empty(), "{bit}");
        if let [first, others @ ..] = &suspects[..] {
            assert_eq!(first.explained, 1.0);
            let unsure = !others.is_empty() && first.evidence().contains("not certain");
            assert!(is_told(first, &place) && others.is_empty() || unsure, "bit {bit}: {suspects:#?}");
        }
    }
}

/// The frames of a sound board up to `first`, and of one with this fault from there on, all of them kept.
fn setting_in(bench: &Bench, text: &str, first: usize) -> CaseInput {
    let faulty = bench.play(Some(fault(text)));
    let mut seen = bench.play(None);
    seen.frames.truncate(first);
    seen.frames.extend(faulty.frames.into_iter().skip(first));
    seen.evidence = faulty.evidence.into_iter().filter(|evidence| evidence.index >= first).collect();
    seen.keep_all(bench.sound_frames());
    seen
}

/// One sample of white frames and later ones differs. A data bit of the table that is stuck gives it too, but would have changed
/// rows of the frames before.
#[test]
fn what_would_have_changed_earlier_rows_is_no_suspect_beside_what_explains_all() {
    let bench = Bench::new(64, 16, 40.0, 2048, Interpolant::Hermite);
    for (row, bit) in [(4, 1), (4, 2), (6, 2), (14, 3)] {
        let seen = setting_in(&bench, &format!("row-factor,row={row},bit={bit},hidden=true"), WHITE);
        let suspects = bench.judge(&seen);
        assert_eq!(suspects.len(), 1, "{suspects:#?}");
        assert!(is_told(&suspects[0], &format!("row {row}'s factor, bit {bit}")), "{suspects:#?}");
        assert!(!suspects[0].evidence().contains("not certain"), "{suspects:#?}");
        assert!(!suspects[0].evidence().contains("began during the run"), "{suspects:#?}");
    }
}
