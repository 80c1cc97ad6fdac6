//! Lines of the line memory.

use halfrow::compare::Comparison;
use halfrow::result::{Evidence, MissingRows};
use halfrow_model::{BitDepth, Frame, Geometry, Interpolant, RowFactor, TableSet};

use crate::bench::{Bench, assert_named, fault, is_told, narrow, wide};
use crate::scenes::Random;

#[test]
fn every_data_line_is_named_with_its_level() {
    for (bit, value) in (0..12).flat_map(|bit| [(bit, 0), (bit, 1)]) {
        let place = format!("line memory, data bit {bit} stuck at {value}");
        assert_named(&narrow(), &format!("stuck-data,bit={bit},value={value}"), &place);
    }
}

/// Of a row that never came back the board said nothing.
#[test]
fn rows_that_never_came_back_contradict_no_suspect() {
    let bench = narrow();
    let mut seen = bench.play(Some(fault("stuck-data,bit=5,value=1")));
    let kept = seen.evidence.last_mut().unwrap();
    let Evidence { found, expected, .. } = &*kept;
    let samples_that_came = 9 * found.width();
    let samples =
        [&found.samples()[..samples_that_came], &vec![0; found.samples().len() - samples_that_came]].concat();
    let mut comparison = Comparison::new(found.width(), found.height());
    (0..9).for_each(|row| comparison.row(row, expected.row(row), found.row(row)));
    kept.found = Frame::new(found.width(), found.depth(), found.phase(), samples).unwrap();
    let came: Vec<_> = (0..16).map(|row| row < 9).collect();
    kept.missing = MissingRows::of(&came);
    let frame = &mut seen.frames[kept.index];
    (frame.rows, frame.comparison) = (9, comparison);
    let suspects = bench.judge(&seen);
    let first = &suspects[0];
    assert!(is_told(first, "line memory, data bit 5 stuck at 1") && first.explained == 1.0, "{suspects:#?}");
}

#[test]
fn every_address_line_is_named() {
    for bit in 0..7 {
        assert_named(
            &narrow(),
            &format!("stuck-address,bit={bit}"),
            &format!("line memory, address bit {bit}"),
        );
    }
}

#[test]
fn every_address_line_of_a_ring_longer_than_a_row_is_named() {
    for bit in 0..8 {
        assert_named(
            &wide(),
            &format!("stuck-address,bit={bit}"),
            &format!("line memory, address bit {bit}"),
        );
    }
}

/// At either level the same addresses share a cell.
#[test]
fn an_address_line_is_named_whatever_its_level() {
    let [low, high] = ["stuck-address,bit=4,value=0", "stuck-address,bit=4,value=1"];
    assert_eq!(wide().diagnose(fault(low)), wide().diagnose(fault(high)));
}

/// In a ring of four rows, the sample that shares a cell comes two rows later.
#[test]
fn an_address_line_that_changes_nothing_is_not_suspected() {
    let bench = Bench { ring: 512, ..narrow() };
    assert_eq!(bench.diagnose(fault("stuck-address,bit=8")), []);
}

#[test]
fn an_address_line_is_named_although_the_ring_did_not_begin_with_the_run() {
    for bit in [0, 3, 5, 6, 7] {
        let bench = Bench { rows_before: 1, ..wide() };
        let suspects = bench.diagnose(fault(&format!("stuck-address,bit={bit}")));
        assert_eq!(suspects[0].place(), format!("line memory, address bit {bit}"), "{suspects:#?}");
        assert_eq!((suspects.len(), suspects[0].explained), (1, 1.0), "{suspects:#?}");
    }
}

#[test]
fn an_address_line_is_named_although_later_frames_were_not_kept() {
    let bench = wide();
    let mut seen = bench.play(Some(fault("stuck-address,bit=6")));
    seen.evidence.retain(|evidence| evidence.index % 2 == 0);
    let suspects = bench.judge(&seen);
    assert_eq!((suspects[0].part(), suspects.len()), ("address bit", 1), "{suspects:#?}");
}

/// Frames with factors of every size that a ring of 2048 samples allows, after `rows_before` other rows.
fn of_every_size(seed: u64, rows_before: u16) -> Bench {
    let mut random = Random::new(seed);
    let one_row = Geometry::centred(1364, 1, BitDepth::Twelve).unwrap();
    let is_legal = |factor| {
        TableSet::new(one_row, vec![RowFactor::new(factor).unwrap()]).unwrap().check_ring(2048).is_ok()
    };
    let one = RowFactor::ONE.get();
    let mut drawn = || {
        let mut factor = 1 + random.below(one.into()) as u32;
        while !is_legal(factor) {
            factor = factor.midpoint(one);
        }
        RowFactor::new(factor).unwrap()
    };
    let geometry = Geometry::centred(1364, 24, BitDepth::Twelve).unwrap();
    let tables = TableSet::new(geometry, (0..24).map(|_| drawn()).collect()).unwrap();
    Bench { rows_before, ..Bench::of(tables, 2048, Interpolant::Hermite) }
}

/// A row that is stretched far reads few columns, and comes out the same for many counts of the ring.
#[test]
fn an_address_line_is_named_by_one_frame_of_rows_that_are_stretched_much() {
    for (seed, bit) in [1, 2, 3].into_iter().flat_map(|seed| [6, 8, 9].map(|bit| (seed, bit))) {
        let bench = of_every_size(seed, seed as u16);
        let mut seen = bench.play(Some(fault(&format!("stuck-address,bit={bit}"))));
        seen.evidence.retain(|evidence| evidence.index == 2);
        let suspects = bench.judge(&seen);
        let first = (suspects[0].place(), suspects[0].explained);
        assert_eq!(first, (format!("line memory, address bit {bit}"), 1.0), "seed {seed}: {suspects:#?}");
    }
}
