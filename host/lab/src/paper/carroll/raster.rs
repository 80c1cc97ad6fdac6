//! Draws a net: each of its meshes as two triangles.

use halfrow::frames::preview::RgbImage;

use super::{KNOTS, Net, angle, knot};

/// A corner of a triangle: the position at which it is shown, and its direction.
type Corner = ((f64, f64), (f64, f64));

/// A picture of `side` x `side` pixels with the colour of each direction, black where the net does not reach.
pub(in super::super) fn shown(net: &Net, side: usize, colour: &dyn Fn(f64, f64) -> [u8; 3]) -> RgbImage {
    let mut image = RgbImage { width: side, height: side, data: vec![0; 3 * side * side] };
    for row in 0..KNOTS - 1 {
        for column in 0..KNOTS - 1 {
            let corner = |down: usize, across: usize| {
                let (x, y) = net.knots[knot(row + down, column + across)];
                let middle = (side as f64 - 1.0) / 2.0;
                ((x + middle, y + middle), (angle(column + across), angle(row + down)))
            };
            fill(&mut image, [corner(0, 0), corner(0, 1), corner(1, 0)], colour);
            fill(&mut image, [corner(1, 1), corner(0, 1), corner(1, 0)], colour);
        }
    }
    image
}

/// Fills the pixels whose middles lie in a triangle.
fn fill(image: &mut RgbImage, corners: [Corner; 3], colour: &dyn Fn(f64, f64) -> [u8; 3]) {
    let [(a, at_a), (b, at_b), (c, at_c)] = corners;
    let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
    let pixels = |low: f64, high: f64, most: usize| {
        (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).clamp(0.0, most as f64) as usize)
    };
    let [ys, xs] = [[a.1, b.1, c.1], [a.0, b.0, c.0]].map(|all| {
        (all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(f64::MIN, f64::max))
    });
    for y in pixels(ys.0, ys.1, image.height) {
        for x in pixels(xs.0, xs.1, image.width) {
            let (across, down) = (x as f64 - a.0, y as f64 - a.1);
            let to_b = (across * (c.1 - a.1) - (c.0 - a.0) * down) / area;
            let to_c = ((b.0 - a.0) * down - across * (b.1 - a.1)) / area;
            // A triangle without an area contains no such pixel.
            if !(to_b >= 0.0 && to_c >= 0.0 && to_b + to_c <= 1.0) {
                continue;
            }
            let mixed = |a: f64, b: f64, c: f64| a + to_b * (b - a) + to_c * (c - a);
            let found = colour(mixed(at_a.0, at_b.0, at_c.0), mixed(at_a.1, at_b.1, at_c.1));
            let place = 3 * (y * image.width + x);
            image.data[place..place + 3].copy_from_slice(&found);
        }
    }
}
