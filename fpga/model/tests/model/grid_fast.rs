//! Every path of the model with grids, against the oracle, bit for bit.

use halfrow_model::{
    BitDepth, Camera, Corrector, Equidistant, Frame, Geometry, Interpolant, Kernel, MAX_WIDTH, ModelPath,
    Phase, TableSet, correct,
};
use proptest::prelude::*;

use crate::fast::{any_kernel, paths, samples};
use crate::grid::{any_grid, shape};
use crate::grid_golden::{Drawn, drawn};

/// The sources of a row, a and x of every column: those of the oracle and those of `corrector`.
fn both(corrector: &Corrector, tables: &TableSet, row: usize) -> [(Vec<i16>, Vec<u16>); 2] {
    let (values, width) = (tables.values(row).unwrap(), tables.geometry().width());
    let of = |column| {
        let source = values.source(column);
        (source.base as i16, (source.node << 8) as u16 + source.fraction as u16)
    };
    let mut found = (vec![i16::MIN; width], vec![0xffff; width]);
    corrector.locate_by_values(tables.geometry(), &values, &mut found.0, &mut found.1);
    [(0..width).map(of).unzip(), found]
}

fn check_sources(tables: &TableSet, rows: &[usize]) {
    for path in ModelPath::available() {
        let corrector = Corrector::new(path, &Interpolant::Linear.into()).unwrap();
        for &row in rows {
            let [expected, found] = both(&corrector, tables, row);
            assert!(expected == found, "{path}, row {row}, {:?}, {:?}", tables.shape(), tables.geometry());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_path_finds_the_sources_of_every_grid(tables in any_grid(MAX_WIDTH), row in any::<prop::sample::Index>()) {
        let row = row.index(tables.geometry().height());
        check_sources(&tables, &[row]);
    }

    #[test]
    fn every_path_corrects_a_frame_behind_a_grid_as_the_oracle_does(
        tables in any_grid(260), kernel in any_kernel(), seed in any::<u32>(), halvings in 0..12_u32,
    ) {
        // With a grid that no ring can serve the samples mean nothing, but no path may fail on it.
        let tables = (0..halvings).fold(tables, |tables, _| tables.halved());
        let geometry = tables.geometry();
        let frame = Frame::new(geometry.width(), geometry.depth(), Phase::Grbg, samples(geometry, seed)).unwrap();
        let expected = correct(&tables, &kernel, &frame).unwrap();
        let inside = |row| {
            let values = tables.values(row).unwrap();
            let ends = [0, geometry.width() - 1].map(|column| (values.coordinate(column) + (1 << 14)) >> 28);
            ends[0] >= 0 && ends[1] < geometry.width() as i64
        };
        for path in paths() {
            let found = Corrector::new(path, &kernel).unwrap().correct(&tables, &frame).unwrap();
            for row in (0..geometry.height()).filter(|&row| inside(row)) {
                prop_assert_eq!(found.row(row), expected.row(row), "{}, row {}", path, row);
            }
        }
    }
}

/// The last block ends with the row, wherever a segment ends.
#[test]
fn every_path_finds_the_sources_at_all_ends_of_a_row() {
    for width in (64..=260).step_by(2) {
        for k in [5, 6] {
            let geometry = Geometry::centred(width, 3, BitDepth::Twelve).unwrap();
            for kind in [Drawn::Narrow, Drawn::Wide] {
                check_sources(&drawn(geometry, shape(1, k), width as u32, kind), &[0, 1, 2]);
            }
        }
    }
}

/// A corrector carries nothing over from grids to factors and back, or from wide rows to narrow ones.
#[test]
fn a_corrector_goes_from_grids_to_factors_and_back() {
    let kernel = Kernel::from(Interpolant::Keys);
    for path in paths() {
        let mut corrector = Corrector::new(path, &kernel).unwrap();
        for width in [MAX_WIDTH, 64, 200] {
            let geometry = Geometry::centred(width, 5, BitDepth::Twelve).unwrap();
            let lens = Equidistant::from_radius(0.6 * width as f64).unwrap();
            let camera = Camera::new(geometry, lens.into(), ((width - 1) as f64 / 2.0, 40.0), 180.0).unwrap();
            let rows =
                TableSet::from_units(geometry, &[9_000_000, 16_000_000, 1, 16_000_000, 9_000_000]).unwrap();
            let frame =
                Frame::new(width, geometry.depth(), Phase::Grbg, samples(&geometry, width as u32)).unwrap();
            for tables in [camera.grid_by_formula(shape(2, 6)), rows] {
                let expected = correct(&tables, &kernel, &frame).unwrap();
                assert!(corrector.correct(&tables, &frame).unwrap() == expected, "{path}, {width} columns");
                let mut output = vec![0xffff; width];
                corrector.correct_row_of(&tables, 1, frame.row(1), &mut output);
                assert!(output == expected.row(1), "{path}, {width} columns");
                corrector.correct_row_of(&tables, 5, frame.row(0), &mut output);
                assert!(output == expected.row(1), "a row that the frame does not have");
            }
        }
    }
}
