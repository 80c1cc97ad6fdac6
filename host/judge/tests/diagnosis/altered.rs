//! Frames that are altered by hand, for defects that the mock does not have.

use halfrow::result::Suspect;
use halfrow::tables::Generation;
use halfrow_model::{Frame, Kernel, RowFactor, TableSet, correct, correct_row, source};

use crate::bench::{Bench, CaseInput, WHITE, fault, narrow, off_centre, wide};

/// The suspects for a board that gives `found`, frame by frame.
pub(crate) fn diagnose(bench: &Bench, found: impl Fn(usize, &Frame, &Frame) -> Vec<u16>) -> Vec<Suspect> {
    bench.judge(&seen(bench, found))
}

/// The frames that `found` makes of the index of each, of what went in and of what should come out.
fn seen(bench: &Bench, found: impl Fn(usize, &Frame, &Frame) -> Vec<u16>) -> CaseInput {
    let mut altered = CaseInput { frames: Vec::new(), evidence: Vec::new() };
    for (index, (generation, input, expected)) in bench.sound_frames().into_iter().enumerate() {
        let samples = found(index, &input, &expected);
        let found = Frame::new(input.width(), input.depth(), input.phase(), samples).unwrap();
        altered.take(generation, input, expected, found);
    }
    altered
}

/// A frame's samples, each row made by `row` from its index.
pub(crate) fn by_row(frame: &Frame, row: impl Fn(usize) -> Vec<u16>) -> Vec<u16> {
    (0..frame.height()).flat_map(row).collect()
}

/// Part and place of the only suspect, which must explain everything.
pub(crate) fn certain(suspects: &[Suspect]) -> (&str, String) {
    let [only] = suspects else { panic!("{suspects:#?}") };
    assert_eq!(only.explained, 1.0, "{only:#?}");
    (only.part(), only.place())
}

/// The reference's frame if row `row` has the factor of row `rows(row)`.
fn remade(bench: &Bench, input: &Frame, rows: impl Fn(usize) -> usize, generation: usize) -> Vec<u16> {
    let tables = &bench.generations[generation].tables;
    let row_factors = (0..input.height()).map(|row| tables.row_factor(rows(row)).unwrap()).collect();
    let tables = TableSet::new(bench.geometry, row_factors).unwrap();
    correct(&tables, &bench.generations[generation].kernel, input).unwrap().samples().to_vec()
}

/// The index of a frame's generation: frames 0 and 1 of the bench are made with the decoy.
pub(crate) fn generation(frame: usize) -> usize {
    usize::from(frame > 1)
}

#[test]
fn a_stuck_line_behind_the_datapath_is_named() {
    let suspects = diagnose(&narrow(), |_, _, expected| expected.samples().iter().map(|s| s | 64).collect());
    assert_eq!(certain(&suspects), ("output bit", "corrected samples, bit 6 stuck at 1".to_owned()));
}

/// A line that flips now and then, which no simulation gives, shows by all differences being in one bit.
#[test]
fn a_flaky_line_behind_the_datapath_tells_its_bit() {
    let flaky = |place: usize, sample: &u16| sample ^ if place.is_multiple_of(97) { 32 } else { 0 };
    let suspects = diagnose(&narrow(), |_, _, expected| {
        expected.samples().iter().enumerate().map(|(place, sample)| flaky(place, sample)).collect()
    });
    assert_eq!((suspects.len(), suspects[0].place().as_str()), (1, "an unknown part"), "{suspects:#?}");
    assert!(suspects[0].evidence().contains("bit 5 alone"), "{}", suspects[0].evidence());
}

#[test]
fn rows_of_the_bank_before_are_named() {
    let suspects = diagnose(&wide(), |_, _, expected| {
        by_row(expected, |row| expected.row(if row % 4 == 2 { row - 1 } else { row }).to_vec())
    });
    assert_eq!(certain(&suspects), ("row bank", "the row banks".to_owned()));
    assert!(suspects[0].evidence().contains("holding the row above"), "{}", suspects[0].evidence());
}

#[test]
fn rows_that_went_in_at_another_place_are_named() {
    let bench = wide();
    let suspects = diagnose(&bench, |frame, input, _| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        by_row(input, |row| {
            let mut output = vec![0; input.width()];
            let from = if row % 8 == 5 { row + 2 } else { row };
            correct_row(
                &bench.geometry,
                tables.row_factor(row).unwrap(),
                kernel,
                input.row(from),
                &mut output,
            );
            output
        })
    });
    assert_eq!(certain(&suspects).0, "row bank");
    assert!(
        suspects[0].evidence().contains("2 below, made with their own factor"),
        "{}",
        suspects[0].evidence()
    );
}

/// What enters at the row's end is unknown, so the last samples do not count against the suspect.
#[test]
fn rows_shifted_along_themselves_are_named() {
    let suspects = diagnose(&narrow(), |_, _, expected| {
        by_row(expected, |row| {
            let mut samples = expected.row(row).to_vec();
            samples.rotate_left(2);
            samples
        })
    });
    assert_eq!(
        certain(&suspects),
        ("row shift", "corrected rows, shifted by 2 columns to the left".to_owned())
    );
}

#[test]
fn exchanged_columns_are_named() {
    let suspects = diagnose(&narrow(), |_, _, expected| {
        expected.samples().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect()
    });
    assert_eq!(certain(&suspects), ("colour", "the pairs of columns".to_owned()));
}

/// The output without its clamp, computed from the samples around the source (DATAPATH.md, "Output sample"), or `aside` columns
/// right of them.
pub(crate) fn sum(
    bench: &Bench,
    generation: usize,
    row: usize,
    input: &[u16],
    (column, aside): (usize, i64),
) -> i32 {
    let Generation { tables, kernel, .. } = &bench.generations[generation];
    let source = source(&bench.geometry, tables.row_factor(row).unwrap(), column);
    let tap = |tap: i64| i32::from(input[bench.geometry.sample_column(source.base + aside - 2 + tap)]);
    let nodes = [kernel.nodes()[source.node], kernel.nodes()[source.node + 1]];
    let weight = |index: usize| {
        let [low, high] = nodes.map(|node| i32::from(node[index]));
        low + (((high - low) * source.fraction + 128) >> 8)
    };
    let own = weight(0) * (tap(0) - tap(2)) + weight(2) * (tap(4) - tap(2)) + weight(4) * (tap(6) - tap(2));
    let other = weight(1) * (tap(1) - tap(3)) + weight(3) * (tap(5) - tap(3));
    (tap(2) * 16384 + own + other + 8192) >> 14
}

#[test]
fn a_missing_clamp_is_named_with_its_end() {
    let bench = narrow();
    let wrapped = |wraps: fn(i32) -> bool| {
        let bench = &bench;
        diagnose(bench, move |frame, input, _| {
            by_row(input, |row| {
                let sums = (0..input.width())
                    .map(|column| sum(bench, generation(frame), row, input.row(row), (column, 0)));
                sums.map(|sum| if wraps(sum) { sum.rem_euclid(4096) } else { sum.clamp(0, 4095) } as u16)
                    .collect()
            })
        })
    };
    assert_eq!(certain(&wrapped(|sum| sum < 0)), ("clamp", "the output's clamp, below 0".to_owned()));
    assert_eq!(
        certain(&wrapped(|sum| sum > 0)),
        ("clamp", "the output's clamp, above the largest sample".to_owned())
    );
    assert_eq!(certain(&wrapped(|_| true)), ("clamp", "the output's clamp, beyond either end".to_owned()));
}

#[test]
fn a_stuck_address_line_of_the_row_table_is_named() {
    let bench = wide();
    let suspects =
        diagnose(&bench, |frame, input, _| remade(&bench, input, |row| row & !4, generation(frame)));
    assert_eq!(certain(&suspects), ("row table address", "row table, address bit 2 stuck at 0".to_owned()));
}

#[test]
fn a_row_counter_that_is_ahead_is_named() {
    let bench = wide();
    let suspects =
        diagnose(&bench, |frame, input, _| remade(&bench, input, |row| (row + 1).min(23), generation(frame)));
    assert_eq!(
        certain(&suspects),
        ("row table address", "the row table's address, one entry ahead".to_owned())
    );
}

#[test]
fn a_factor_of_any_value_is_found() {
    let bench = wide();
    let wrong = RowFactor::new(13_131_313).unwrap();
    let suspects = diagnose(&bench, |frame, input, expected| {
        let kernel = &bench.generations[generation(frame)].kernel;
        let mut samples = expected.samples().to_vec();
        if generation(frame) == 1 {
            let output = &mut samples[4 * input.width()..][..input.width()];
            correct_row(&bench.geometry, wrong, kernel, input.row(4), output);
        }
        samples
    });
    assert_eq!(certain(&suspects), ("row factor", "row 4's factor".to_owned()));
    let figures: Vec<u32> =
        suspects[0].evidence().split(|c: char| !c.is_ascii_digit()).filter_map(|w| w.parse().ok()).collect();
    assert!(figures[0].abs_diff(wrong.get()) < 4096, "{}", suspects[0].evidence());
}

/// A cell that lost two bits holds another value in each generation's tables.
#[test]
fn a_factor_that_is_wrong_in_two_bits_is_found_in_all_tables() {
    let bench = wide();
    let suspects = diagnose(&bench, |frame, input, expected| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        let mut samples = expected.samples().to_vec();
        let wrong = RowFactor::new(tables.row_factor(4).unwrap().get() ^ 0b11 << 18).unwrap();
        let output = &mut samples[4 * input.width()..][..input.width()];
        correct_row(&bench.geometry, wrong, kernel, input.row(4), output);
        samples
    });
    assert_eq!(certain(&suspects), ("row factor", "row 4's factor".to_owned()), "{suspects:#?}");
    assert!(!suspects[0].evidence().contains("generation"), "{}", suspects[0].evidence());
}

#[test]
fn a_weight_that_is_wrong_in_two_bits_is_found_in_all_tables() {
    let bench = wide();
    let suspects = diagnose(&bench, |frame, input, _| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        let mut nodes = kernel.nodes().to_vec();
        nodes[16][2] ^= 0b11 << 11;
        correct(tables, &Kernel::from_nodes(nodes).unwrap(), input).unwrap().samples().to_vec()
    });
    assert_eq!(certain(&suspects), ("kernel word", "kernel node 16, weight g4".to_owned()), "{suspects:#?}");
    assert!(!suspects[0].evidence().contains("generation"), "{}", suspects[0].evidence());
}

#[test]
fn a_weight_of_any_value_is_found() {
    let bench = wide();
    let suspects = diagnose(&bench, |frame, input, _| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        let mut nodes = kernel.nodes().to_vec();
        if generation(frame) == 1 {
            nodes[16][2] = -1234;
        }
        correct(tables, &Kernel::from_nodes(nodes).unwrap(), input).unwrap().samples().to_vec()
    });
    assert_eq!(certain(&suspects), ("kernel word", "kernel node 16, weight g4".to_owned()));
    assert!(
        suspects[0].evidence().starts_with("with the value read as -1234 instead of 2560"),
        "{}",
        suspects[0].evidence()
    );
}

#[test]
fn a_kernel_that_is_stale_while_the_factors_are_not_is_named() {
    let bench = narrow();
    let suspects = diagnose(&bench, |frame, input, _| {
        let kernel = &bench.generations[0].kernel;
        correct(&bench.generations[generation(frame)].tables, kernel, input).unwrap().samples().to_vec()
    });
    assert_eq!(certain(&suspects).0, "stale tables");
    assert!(
        suspects[0].evidence().contains("with the kernel of generation 1 instead of 2"),
        "{}",
        suspects[0].evidence()
    );
}

/// Two broken factors are two parts, each of which explains its own row.
#[test]
fn two_defects_are_both_named_and_neither_for_certain() {
    let bench = wide();
    let suspects = diagnose(&bench, |frame, input, expected| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        let mut samples = expected.samples().to_vec();
        for (row, bit) in [(3, 20), (21, 22)] {
            let output = &mut samples[row * input.width()..][..input.width()];
            let wrong = RowFactor::new(tables.row_factor(row).unwrap().get() ^ 1 << bit).unwrap();
            correct_row(&bench.geometry, wrong, kernel, input.row(row), output);
        }
        samples
    });
    let mut places: Vec<_> = suspects.iter().map(Suspect::place).collect();
    places.retain(|place| place.starts_with("row"));
    places.sort_unstable();
    assert_eq!(places, ["row 21's factor, bit 22", "row 3's factor, bit 20"]);
    assert!(suspects.iter().all(|suspect| suspect.explained < 1.0));
}

/// No known defect makes a single column one brighter.
#[test]
fn what_nothing_explains_is_described() {
    let suspects = diagnose(&narrow(), |_, _, expected| {
        let brighter = |(place, &sample): (usize, &u16)| (sample + u16::from(place % 128 == 44)).min(4095);
        expected.samples().iter().enumerate().map(brighter).collect()
    });
    let first = &suspects[0];
    assert_eq!((first.part(), first.explained), ("unknown", 0.0));
    assert!(first.designer().ends_with("*Golden values* of fpga/DATAPATH.md."), "{}", first.designer());
    for clause in ["in every row", "all in column 44", "all off by +1", "in 8 of 9 frames"] {
        assert!(first.evidence().contains(clause), "{}", first.evidence());
    }
}

#[test]
fn differences_of_which_no_frame_was_kept_are_described() {
    let bench = narrow();
    let mut seen = seen(&bench, |_, _, expected| expected.samples().iter().map(|s| s ^ 1).collect());
    seen.evidence.clear();
    let suspects = bench.judge(&seen);
    assert_eq!((suspects.len(), suspects[0].part()), (1, "unknown"));
}

/// A white frame does not show whether its samples lost a bit before the datapath or after it.
#[test]
fn defects_that_cannot_be_told_apart_are_all_named() {
    let bench = narrow();
    let mut seen = bench.play(Some(fault("stuck-data,bit=5,value=0")));
    seen.evidence.retain(|evidence| evidence.index == WHITE);
    let suspects = bench.judge(&seen);
    let places: Vec<_> = suspects.iter().map(Suspect::place).collect();
    assert_eq!(places, ["line memory, data bit 5 stuck at 0", "corrected samples, bit 5 stuck at 0"]);
    assert!(suspects.iter().all(|suspect| suspect.explained == 1.0));
    assert!(
        suspects
            .iter()
            .all(|suspect| suspect.evidence().ends_with("so does one other defect, so this is not certain"))
    );
}

/// Frames, tables and indices that do not belong together must not end the program.
#[test]
fn evidence_of_another_size_is_left_aside() {
    let (narrow, wide) = (narrow(), wide());
    let mut seen = seen(&narrow, |_, _, expected| expected.samples().iter().map(|s| s ^ 1).collect());
    assert_eq!(wide.judge(&seen)[0].part(), "unknown");
    for evidence in &mut seen.evidence {
        evidence.index += 100;
    }
    assert_eq!(narrow.judge(&seen)[0].part(), "unknown");
}

#[test]
fn a_narrower_depth_and_a_shifted_centre_are_no_obstacle() {
    let bench = off_centre();
    let suspects = diagnose(&bench, |frame, input, _| {
        let Generation { tables, kernel, .. } = &bench.generations[generation(frame)];
        let mut nodes = kernel.nodes().to_vec();
        nodes[20][2] ^= 1 << 12;
        correct(tables, &Kernel::from_nodes(nodes).unwrap(), input).unwrap().samples().to_vec()
    });
    assert_eq!(certain(&suspects), ("kernel word", "kernel node 20, weight g4, bit 12".to_owned()));
}

/// Bit 6 stuck at 1 in even columns, which is a quarter of all samples, and every sample of odd ones changed: a third of what
/// differs is no cause of it.
#[test]
fn a_part_that_explains_less_than_half_is_not_named_first() {
    let suspects = diagnose(&narrow(), |_, _, expected| {
        let altered = |(place, &sample): (usize, &u16)| {
            if place % 2 == 0 { sample | 64 } else { sample ^ (1 + sample % 7) }
        };
        expected.samples().iter().enumerate().map(altered).collect()
    });
    assert_eq!((suspects[0].part(), suspects[0].explained), ("unknown", 0.0), "{suspects:#?}");
    assert!(suspects[1..].iter().all(|other| (0.2..0.5).contains(&other.explained)), "{suspects:#?}");
    let is_stuck = |other: &Suspect| other.place().starts_with("corrected samples, bit 6 stuck at 1");
    assert!(suspects.iter().any(is_stuck), "{suspects:#?}");
    // Where nothing explains everything, nothing else explains it as well.
    assert!(suspects.iter().all(|suspect| suspect.others() == 0), "{suspects:#?}");
}

/// 2047 is half of what 12 bits hold.
#[test]
fn samples_are_bright_that_are_more_than_half() {
    let evidence = |least: u16| {
        let suspects = diagnose(&narrow(), |_, _, expected| {
            let altered = |&sample: &u16| if sample > least { sample ^ (1 + sample % 3) } else { sample };
            expected.samples().iter().map(altered).collect()
        });
        assert_eq!(suspects[0].part(), "unknown", "{suspects:#?}");
        suspects[0].evidence()
    };
    let (bright, any) = (evidence(2047), evidence(1500));
    let clause = "of half the range and above";
    assert!(bright.contains(clause) && !any.contains(clause), "{bright}; {any}");
}
