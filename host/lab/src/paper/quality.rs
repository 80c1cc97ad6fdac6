//! How well a projection keeps what people notice: straight lines and shapes.

use super::exhibit::largest;
use super::lines::Line;

/// How far from the middle shapes are measured, in degrees of longitude and latitude: as far as every view shows them.
pub(super) const SHOWN: (f64, f64) = (60.0, 45.0);

/// Degrees between two of these directions. A view's derivatives are computed over half of it to either side.
const STEP: f64 = 2.5;

/// The position at which a direction, longitude and latitude in radians, is shown, in pixels.
pub(super) type Place<'a> = &'a dyn Fn(f64, f64) -> (f64, f64);

/// The largest distance of a point of a line from the line's chord, in pixels.
pub(super) fn straightness(place: Place<'_>, lines: &[Line]) -> f64 {
    largest(lines.iter().map(|line| from_chord(place, line)))
}

fn from_chord(place: Place<'_>, line: &Line) -> f64 {
    let points: Vec<_> =
        line.directions.iter().map(|&(longitude, latitude)| place(longitude, latitude)).collect();
    let [Some(&(x, y)), Some(&(end_x, end_y))] = [points.first(), points.last()] else { return 0.0 };
    let (across, down) = (end_x - x, end_y - y);
    let length = across.hypot(down).max(f64::MIN_POSITIVE);
    let away = |(px, py): &(f64, f64)| ((px - x) * down - (py - y) * across).abs() / length;
    largest(points.iter().map(away))
}

/// The mean of |ln(σ1/σ2)| over the directions that are measured; σ1 and σ2 are the singular values of the view's derivative on
/// the sphere. 0 means that every small shape keeps its form.
pub(super) fn conformality(place: Place<'_>) -> f64 {
    let steps = |reach: f64| {
        let count = (reach / STEP) as i32;
        (-count..=count).map(|step| (f64::from(step) * STEP).to_radians())
    };
    let (mut sum, mut area) = (0.0, 0.0);
    for latitude in steps(SHOWN.1) {
        for longitude in steps(SHOWN.0) {
            sum += latitude.cos() * shear(place, longitude, latitude);
            area += latitude.cos();
        }
    }
    sum / area
}

/// |ln(σ1/σ2)| at a direction.
fn shear(place: Place<'_>, longitude: f64, latitude: f64) -> f64 {
    let half = (STEP / 2.0).to_radians();
    let difference = |ends: [(f64, f64); 2], angle: f64| {
        let [from, to] = ends;
        ((to.0 - from.0) / angle, (to.1 - from.1) / angle)
    };
    let along = [-half, half].map(|aside| place(longitude + aside, latitude));
    let down = [-half, half].map(|below| place(longitude, latitude + below));
    let (a, c) = difference(along, 2.0 * half * latitude.cos());
    let (b, d) = difference(down, 2.0 * half);
    let (square, determinant) = (a * a + b * b + c * c + d * d, (a * d - b * c).abs());
    // σ1² and σ2² have this sum, and the square of this product.
    let root = (square * square - 4.0 * determinant * determinant).max(0.0).sqrt();
    0.5 * ((square + root) / (square - root).max(f64::MIN_POSITIVE)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_kept_by_mercator_and_stretched_by_a_plane() {
        let mercator = |longitude: f64, latitude: f64| (longitude, latitude.tan().asinh());
        assert!(conformality(&mercator) < 1e-3);
        // For a gnomonic view σ1/σ2 = 1/cos θ, so the mean is that of −ln cos θ over the same directions.
        let gnomonic = |longitude: f64, latitude: f64| (longitude.tan(), latitude.tan() / longitude.cos());
        assert!((shear(&gnomonic, 1.0, 0.0) + 1.0_f64.cos().ln()).abs() < 1e-2);
        assert!((0.2..0.4).contains(&conformality(&gnomonic)));
    }

    #[test]
    fn a_line_is_as_crooked_as_its_farthest_point_is_from_its_chord() {
        let lines = [Line {
            directions: vec![(0.0, 0.0), (0.5, 0.0), (1.0, 0.0)],
            held: super::super::lines::Constraint::Straight,
        }];
        let bent = |longitude: f64, _| (3.0 * longitude, if longitude == 0.5 { 0.25 } else { 0.0 });
        assert_eq!(straightness(&bent, &lines), 0.25);
        let lost = |longitude: f64, _| (longitude, if longitude == 0.5 { f64::NAN } else { 0.0 });
        assert!(straightness(&lost, &lines).is_nan(), "a point that is nowhere lies on no line");
    }
}
