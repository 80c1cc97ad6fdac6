//! Grids from lenses: the projection against its inverse, the errors that grids leave, and which grid is chosen.

use halfrow_model::{
    BitDepth, CalibratedLens, Camera, Equidistant, Geometry, GridResidual, GridResiduals, GridShape,
    LONGEST_RING, Profile, RowFactor, TableError, TableSet, exact_inverse,
};
use proptest::prelude::*;

use crate::calibrated::{DSL215_CENTRE, dsl215, kannala_brandt};
use crate::grid::{identity, shape};
use crate::lens::assert_close;

fn camera(size: (usize, usize), lens: impl Into<CalibratedLens>, centre: (f64, f64)) -> Camera {
    let geometry = Geometry::centred(size.0, size.1, BitDepth::Twelve).unwrap();
    Camera::new(geometry, lens.into(), centre, 180.0).unwrap()
}

fn paper(size: (usize, usize), scale: f64) -> Camera {
    let lens = Equidistant::from_radius(1106.697 * scale).unwrap();
    camera(size, lens, ((size.0 - 1) as f64 / 2.0, (size.1 - 1) as f64 / 2.0))
}

/// The DSL215 on half as many pixels as it was measured with, for which a small grid is enough.
fn half_dsl215() -> Camera {
    let centre = (DSL215_CENTRE.0 / 2.0, DSL215_CENTRE.1 / 2.0);
    camera((376, 240), dsl215().scaled(0.5).unwrap(), centre)
}

fn residuals(camera: &Camera, tables: &TableSet, step: usize) -> GridResiduals {
    let [found] = camera.each_grid_residuals([tables], step);
    found
}

fn largest(camera: &Camera, tables: &TableSet) -> f64 {
    residuals(camera, tables, 3).inner.max
}

fn check_ring(tables: &TableSet) {
    assert_eq!(tables.check_ring(tables.geometry().width().next_power_of_two()), Ok(()));
}

#[test]
fn sources_of_an_equidistant_lens_are_the_inverse_of_eq_6() {
    let lens = Equidistant::from_radius(500.0).unwrap();
    let camera = camera((960, 700), lens, (400.5, 300.0));
    for (column, row) in [(0.0, 0.0), (400.5, 17.0), (400.0, 300.0), (899.75, 699.0), (12.5, -100.0)] {
        let (x_d, _) = exact_inverse(&lens, column - 400.5, row - 300.0).unwrap();
        assert_close(camera.source_column(column, row), 400.5 + x_d);
    }
}

#[test]
fn what_a_source_shows_belongs_at_its_output() {
    let cameras = [half_dsl215(), camera((640, 360), kannala_brandt(0.5), (316.5, 171.25))];
    for camera in cameras {
        let (centre_x, centre_y) = camera.centre();
        for (column, row) in [(centre_x + 7.0, centre_y), (30.0, 10.0), (200.0, 230.0), (340.0, 5.5)] {
            let source = camera.source_column(column, row);
            let ray = camera.lens().ray(source - centre_x, row - centre_y).unwrap();
            let (right, _) = camera.lens().straightened(ray).unwrap();
            assert_close(right, column - centre_x);
        }
    }
}

/// Computed outside the project: 0.0013 columns at most and 0.0002 on average, at every fifth column and row.
#[test]
fn the_golden_table_leaves_what_was_computed_elsewhere() {
    let camera = paper((1920, 1080), 1.0);
    let GridResiduals { circle, inner, rim, beyond } =
        residuals(&camera, &camera.grid_by_formula(shape(5, 6)), 5);
    assert!(
        (0.001_25..0.001_35).contains(&circle.max) && (0.000_15..0.000_25).contains(&circle.mean),
        "{circle:?}"
    );
    // The frame ends within 85 degrees and within 0.9 of the circle's height.
    assert_eq!((inner, rim, beyond), (circle, GridResidual::default(), 0.0));
    assert!(circle.share.abs() < f64::EPSILON);
    // Eq. 9 leaves errors of up to 35 columns in the corrected frame.
    let by_rows = residuals(&camera, &camera.equation_9(), 5);
    assert!(by_rows.circle.max > 10.0 && by_rows.circle.share > 0.9, "{by_rows:?}");
}

#[test]
fn a_fit_is_nearer_than_the_formula_and_the_same_every_time() {
    for (camera, shape, gain) in [
        (paper((480, 270), 0.25), shape(4, 6), 0.6),
        (half_dsl215(), shape(3, 5), 0.9),
        (paper((480, 270), 0.2), shape(5, 5), 0.7),
    ] {
        let closed = camera.grid_by_formula(shape);
        let fitted = camera.fitted_grid(shape);
        let (before, after) = (largest(&camera, &closed), largest(&camera, &fitted));
        assert!(after < gain * before, "{shape}: {after} instead of {before}");
        assert_eq!(fitted, camera.fitted_grid(shape));
        check_ring(&fitted);
    }
}

#[test]
fn the_best_grid_has_the_least_error_that_the_entries_allow() {
    let camera = paper((320, 180), 1.0 / 6.0);
    let mut before = f64::INFINITY;
    for entries in [48, 90, 200, 2048] {
        let best = camera.best_grid(entries).unwrap();
        assert!(best.entries().len() <= entries);
        let found = largest(&camera, &best);
        assert!(found < before, "{found} with {entries} entries, {before} with fewer");
        for shape in GridShape::all().filter(|shape| shape.entries(camera.geometry()) <= entries) {
            let other = largest(&camera, &camera.fitted_grid(shape));
            assert!(found <= 1.01 * other, "{found} with {entries} entries, {other} with {shape}");
        }
        before = found;
        check_ring(&best);
    }
}

/// With the axis in a corner, only coarse grids need no more than 256 samples of 256 columns, and they are wrong by 17 columns.
#[test]
fn a_grid_that_is_much_nearer_may_need_a_longer_ring() {
    let lens = Equidistant::from_radius(170.0).unwrap();
    let geometry = Geometry::centred(256, 192, BitDepth::Eight).unwrap();
    let camera = Camera::new(geometry, lens.into(), (0.0, 0.0), 180.0).unwrap();
    let best = camera.best_grid(2048).unwrap();
    assert!(best.check_ring(256).is_err() && best.check_ring(512).is_ok());
    let found = residuals(&camera, &best, 1).inner.max;
    assert!(found < 0.2, "{found}");
}

/// Next to a pole in the upper left, rows begin so far right that a board would have to look ahead too far.
#[test]
fn where_no_ring_serves_a_grid_the_best_one_is_refused() {
    let geometry = Geometry::centred(96, 96, BitDepth::Twelve).unwrap();
    let lens = Equidistant::from_radius(96.0).unwrap();
    let camera = Camera::new(geometry, lens.into(), (95.0, 95.0), 180.0).unwrap();
    let best = camera.best_grid(2048).unwrap();
    let found = residuals(&camera, &best, 1).inner.max;
    assert!(found < 0.5, "{found}");
    let refused = best.check_ring(LONGEST_RING);
    assert!(matches!(refused, Err(TableError::LookAhead { .. })), "{refused:?}");
}

/// The finest two have 83 · 202 and 83 · 102 entries, which would take too long to fit.
#[test]
fn a_grid_of_very_many_entries_is_not_fitted() {
    let camera = paper((2592, 400), 1.0);
    let [few, many] = [2048, 20_000].map(|entries| camera.best_grid_with_k(5, entries).unwrap());
    assert!(many.entries().len() <= 8192, "{:?}", many.shape());
    assert!(largest(&camera, &many) < 1.01 * largest(&camera, &few));
}

/// By hand: r = 50 · (θ − 0.2 · θ³) turns back at θ = √(5/3), 43.03 columns from the axis. On its row 87 of 160 outputs show
/// something, and outputs that show nothing must not draw the others away.
#[test]
fn beyond_where_a_lens_turns_back_outputs_count_nowhere() {
    let geometry = Geometry::centred(160, 120, BitDepth::Twelve).unwrap();
    let profile = Profile::KannalaBrandt([-0.2, 0.0, 0.0, 0.0]);
    let lens = CalibratedLens::new(profile, [[50.0, 0.0], [0.0, 50.0]]).unwrap();
    let camera = Camera::new(geometry, lens.clone(), (80.0, 60.0), 147.8).unwrap();
    let best = camera.best_grid(2048).unwrap();
    let found = residuals(&camera, &best, 1);
    assert_close(found.beyond, camera.share_beyond());
    let low = Geometry::centred(160, 1, BitDepth::Twelve).unwrap();
    let flat = Camera::new(low, lens, (80.0, 0.0), 147.8).unwrap();
    assert_close(flat.share_beyond(), 1.0 - 87.0 / 160.0);
    let rows = residuals(&camera, &camera.fitted(), 1);
    assert!(found.inner.max < 0.6 * rows.inner.max, "{found:?} {rows:?}");
}

#[test]
fn too_few_entries_are_refused_with_what_fits() {
    let camera = paper((1920, 1080), 1.0);
    let refused = camera.best_grid(607).unwrap_err();
    // (30 + 2) · (floor(1079/64) + 3) = 32 · 19.
    assert_eq!((refused.entries, refused.least), (607, 608));
    assert_eq!(
        refused.to_string(),
        "no grid for frames of 1920 x 1080 has 607 entries or fewer; take a board of at least 608, which the shape \
         v = 6, k = 6 needs, or smaller frames"
    );
}

/// A frame that contains the poles and the rim of the circle of 180 degrees.
fn around_the_circle() -> (Equidistant, Camera) {
    let lens = Equidistant::from_radius(80.0).unwrap();
    (lens, camera((256, 200), lens, (127.5, 99.5)))
}

/// The samples of [`around_the_circle`]'s frame, relative to its axis.
fn places() -> impl Iterator<Item = (f64, f64)> {
    (0..200).flat_map(|row| (0..256).map(move |column| (f64::from(column) - 127.5, f64::from(row) - 99.5)))
}

/// Whether a sample is inner: 85 degrees off the axis are 80 · 85/90 pixels, and 0.9 of the circle's height is 72.
fn is_inner(x: f64, y: f64) -> bool {
    x.hypot(y) <= 80.0 * 85.0 / 90.0 && y.abs() <= 72.0
}

/// The errors of a table that moves nothing, at every output within 90 degrees: there x of Eq. 6 is 80 columns from the axis.
#[test]
fn what_no_table_leaves_is_the_projection_itself() {
    let (lens, camera) = around_the_circle();
    let found = residuals(&camera, &identity(*camera.geometry(), shape(6, 6)), 1);
    let shown = places().filter(|&(x, y)| x.abs() <= 80.0 && y.abs() < 0.998 * 80.0);
    let wrong: Vec<_> = shown.map(|(x, y)| (exact_inverse(&lens, x, y).unwrap().0, x, y)).collect();
    let amounts = |is_wanted: fn(f64, f64) -> bool| {
        let wanted = wrong.iter().filter(move |&&(source, _, y)| is_wanted(source, y));
        wanted.map(|(source, x, _)| (source - x).abs()).collect::<Vec<_>>()
    };
    for (residual, amounts) in [
        (found.inner, amounts(is_inner)),
        (found.rim, amounts(|x, y| !is_inner(x, y))),
        (found.circle, amounts(|_, _| true)),
    ] {
        let (sum, max) = (amounts.iter().sum::<f64>(), amounts.iter().copied().fold(0.0, f64::max));
        assert_close(residual.max, max);
        assert_close(residual.mean, sum / amounts.len() as f64);
    }
    assert_close(found.beyond, 1.0 - wrong.len() as f64 / (256.0 * 200.0));
}

#[test]
fn targets_are_inner_where_the_page_says() {
    let (_, camera) = around_the_circle();
    let found = (0..200).flat_map(|row| camera.targets(row)).filter(|target| target.is_inner).count();
    assert_eq!(found, places().filter(|&(x, y)| is_inner(x, y)).count());
}

/// A row that does not move shows a single column. Its residuals must still be numbers. By hand: sample (165, 137) is 53.0330
/// pixels off the axis, on the diagonal. So θ = 59.6621 degrees, the latitude is asin(sin θ/√2) = 37.6095 degrees, and the
/// right row is 33.4307 below the axis.
#[test]
fn a_grid_that_moves_nothing_leaves_residuals_that_are_numbers() {
    let (_, camera) = around_the_circle();
    let still = vec![0; shape(6, 6).entries(camera.geometry())];
    let still = TableSet::from_grid(*camera.geometry(), shape(6, 6), &still).unwrap();
    // One that hardly moves shows most columns nowhere near: the frame is 256 wide, and they count at most as far from its ends.
    let creeping = vec![8; still.entries().len()];
    let creeping = TableSet::from_grid(*camera.geometry(), shape(6, 6), &creeping).unwrap();
    assert!(camera.residuals(&creeping, 137).all(|(_, residual)| residual.columns.abs() <= 512.0));
    let found: Vec<_> = camera.residuals(&still, 137).collect();
    assert!(!found.is_empty() && found.iter().all(|(_, residual)| residual.columns.is_finite()));
    let &(target, diagonal) = found.iter().find(|(target, _)| target.column == 165).unwrap();
    for residual in [diagonal, camera.residual(137, RowFactor::ONE, target)] {
        assert!((residual.rows - (37.5 - 33.4307)).abs() < 1e-3, "{residual:?}");
    }
}

/// Rows beyond a pole are like the row at the pole. Beyond 90 degrees sources are a column apart, or up to 1.5 columns next to
/// a pole.
#[test]
fn a_frame_that_shows_more_than_the_circle_has_a_grid() {
    let (lens, camera) = around_the_circle();
    let pole: f64 = 0.998 * 80.0;
    for (column, row) in [(100.0, 0.0), (127.5, 19.5), (180.0, 199.0)] {
        let (x_d, _) = exact_inverse(&lens, column - 127.5, pole.copysign(row - 99.5)).unwrap();
        assert_close(camera.source_column(column, row), 127.5 + x_d);
    }
    let beyond = [250.0, 251.0].map(|column| camera.source_column(column, 99.5));
    assert!((beyond[1] - beyond[0] - 1.0).abs() < 0.05, "{beyond:?}");
    // In row 20 the circle ends √(80² − 79.5²) = 8.9303 columns from the axis, and that place belongs 80 columns from it.
    let (last, far) = (127.5 + 8.9303, camera.source_column(255.0, 20.0));
    assert!((last..=last + 1.5 * 47.5).contains(&far), "{far}");
    let best = camera.best_grid(2048).unwrap();
    check_ring(&best);
    let residuals = residuals(&camera, &best, 1);
    assert!(residuals.inner.max < 0.5 && residuals.inner.share < residuals.circle.share, "{residuals:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Every lens that is accepted has a grid. Where the grid is legal, the row's ends lie in the row.
    #[test]
    fn every_lens_has_a_grid(
        half in 32..=100_usize, height in 1..=120_usize, radius in prop_oneof![1.0..20.0, 20.0..400.0, 400.0..1e9],
        place in (0.0..1.0, -1.0..2.0), v in 1..=6_u32, k in 5..=6_u32, calibrated in any::<bool>(),
    ) {
        let (width, centre) = (2 * half, (place.0 * (2 * half - 1) as f64, place.1 * height as f64));
        let lens = Equidistant::from_radius(radius).unwrap();
        let lens = if calibrated { dsl215().scaled(radius / 388.0).unwrap() } else { lens.into() };
        let geometry = Geometry::centred(width, height, BitDepth::Twelve).unwrap();
        if let Ok(camera) = Camera::new(geometry, lens, centre, 180.0) {
            let tables = camera.grid_by_formula(shape(v, k));
            prop_assert_eq!(tables.entries().len(), shape(v, k).entries(&geometry));
            let residuals = residuals(&camera, &tables, 7);
            prop_assert!(residuals.circle.max.is_finite());
            // Every row begins inside the frame or to the right of it.
            let begins = |row| tables.values(row).unwrap().coordinate(0) >= -(1 << 14);
            prop_assert!((0..height).all(begins));
        }
    }
}

#[test]
fn rows_that_tables_do_not_have_leave_nothing() {
    let of_height = |height| {
        let geometry = Geometry::centred(64, height, BitDepth::Twelve).unwrap();
        let lens = Equidistant::from_radius(60.0).unwrap();
        Camera::new(geometry, lens.into(), geometry.middle(), 180.0).unwrap()
    };
    let (high, low) = (of_height(48), of_height(4));
    let of_low_rows = residuals(&high, &low.equation_9(), 7);
    assert!(of_low_rows.circle.max.is_finite());
    let narrow = Geometry::centred(64, 48, BitDepth::Twelve).unwrap();
    let wide = Geometry::centred(200, 48, BitDepth::Twelve).unwrap();
    let camera =
        Camera::new(wide, Equidistant::from_radius(60.0).unwrap().into(), wide.middle(), 180.0).unwrap();
    let tables = TableSet::from_units(narrow, &[1 << 23; 48]).unwrap();
    assert!(residuals(&camera, &tables, 7).circle.max.is_finite());
}
