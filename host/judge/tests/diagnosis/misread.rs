//! Sentences of the pages that are easily read otherwise, as whoever makes a new board may do.

use halfrow_model::source;

use crate::altered::{by_row, certain, diagnose, generation, sum};
use crate::bench::{assert_named, grid, narrow, off_centre, off_centre_grid, wide};

#[test]
fn a_misread_sentence_of_the_datapath_is_named() {
    for (instead, place) in [
        ("unsigned-weights", "the sign of the kernel's weights"),
        ("weights-toward-zero", "the rounding of interpolated weights, toward zero"),
        ("unrounded-source", "the rounding of source coordinates"),
        ("next-node", "the kernel's address, one node ahead"),
        ("nearest-edge", "the samples beyond the row's ends"),
    ] {
        for bench in [narrow(), wide(), off_centre(), grid(), off_centre_grid()] {
            assert_named(&bench, &format!("misread,instead={instead}"), place);
        }
    }
}

/// Column 5 of the page's worked example has its base at 7, since 8 has the other colour; here that is 9.
#[test]
fn a_base_column_right_of_the_source_is_named() {
    let bench = narrow();
    let suspects = diagnose(&bench, |frame, input, _| {
        let generation = generation(frame);
        by_row(input, |row| {
            let factor = bench.generations[generation].tables.row_factor(row).unwrap();
            let output = |column: usize| {
                let n = source(&bench.geometry, factor, column).column;
                let aside = if (n - column as i64) % 2 == 0 { 0 } else { 2 };
                sum(&bench, generation, row, input.row(row), (column, aside)).clamp(0, 4095) as u16
            };
            (0..input.width()).map(output).collect()
        })
    });
    assert_eq!(certain(&suspects), ("colour", "the side of the base column".to_owned()));
}

/// Two samples are packed into 24 bits, s0 + 2^12·s1, of which the lowest byte must go first (WIRE.md, 5).
#[test]
fn pairs_that_are_packed_the_other_way_round_are_named() {
    let unpacked = |bytes: [u16; 3]| [bytes[0] | (bytes[1] & 15) << 8, bytes[1] >> 4 | bytes[2] << 4];
    let packed = |first: u16, second: u16| [first & 255, first >> 8 | (second & 15) << 4, second >> 4];
    let found = |way: fn([u16; 3], u16, u16) -> [u16; 3]| {
        diagnose(&narrow(), move |_, _, expected| {
            let pairs = expected.samples().chunks(2);
            pairs.flat_map(|pair| unpacked(way(packed(pair[0], pair[1]), pair[0], pair[1]))).collect()
        })
    };
    let reversed = found(|[low, middle, high], _, _| [high, middle, low]);
    let in_front = found(|_, first, second| [first >> 4, (first & 15) << 4 | second >> 8, second & 255]);
    for (suspects, place) in [(reversed, "each pair's bytes reversed"), (in_front, "first sample in front")] {
        let (part, told) = certain(&suspects);
        assert!(part == "packing" && told.ends_with(place), "{suspects:#?}");
    }
    assert_eq!(found(|bytes, _, _| bytes), []);
}
