//! The street's straight lines, for projections that are made from them.

use super::town::{CAMERA, ROWS, Row, Side};

/// A straight line of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneLine {
    /// Its ends, in metres from the camera: to the right, down, ahead.
    pub ends: [[f64; 3]; 2],
    /// Whether it stands upright; the others are level.
    pub is_upright: bool,
}

/// The edges between neighbouring façades, the lines of the roofs, and the lines where the façades meet the ground, as far as
/// they are ahead of the camera.
#[must_use]
pub fn lines() -> Vec<SceneLine> {
    ROWS.iter().flat_map(|row| upright(row).chain(level(row)).chain(foot(row))).collect()
}

/// How far ahead of the camera lines begin to count, in metres.
const AHEAD: f64 = 0.5;

/// From the ground to the lower of two neighbours' roofs.
fn upright(row: &Row) -> impl Iterator<Item = SceneLine> {
    row.houses.windows(2).filter_map(|pair| {
        let roof = pair[0].roof.min(pair[1].roof);
        let ends = [0.0, roof].map(|height| row.place(pair[0].to, height));
        (ends[0][2] > AHEAD).then_some(SceneLine { ends, is_upright: true })
    })
}

/// Along the roof of each house.
fn level(row: &Row) -> impl Iterator<Item = SceneLine> {
    row.houses.iter().filter_map(|house| {
        let (first, last) = row.seen()?;
        let (from, to) = (house.from.max(first), house.to.min(last));
        let ends = [from, to].map(|along| row.place(along, house.roof));
        (from < to).then_some(SceneLine { ends, is_upright: false })
    })
}

/// Where the whole row meets the ground.
fn foot(row: &Row) -> Option<SceneLine> {
    let (first, last) = row.seen()?;
    Some(SceneLine { ends: [first, last].map(|along| row.place(along, 0.0)), is_upright: false })
}

impl Row {
    /// The first and last place along the row that are seen: ahead of the camera, and between the rows at the sides.
    fn seen(&self) -> Option<(f64, f64)> {
        let (first, last) = (self.houses.first()?.from, self.houses.last()?.to);
        if self.side != Side::Across {
            return Some((first.max(AHEAD), last));
        }
        let beside = |side: Side| {
            let row = ROWS.iter().find(|row| row.side == side)?;
            Some(row.distance * self.distance / row.houses.last()?.to)
        };
        Some((first.max(-beside(Side::Left)?), last.min(beside(Side::Right)?)))
    }

    /// The place on its façades at `along` the row and `height` above the ground.
    fn place(&self, along: f64, height: f64) -> [f64; 3] {
        let down = CAMERA - height;
        match self.side {
            Side::Left => [-self.distance, down, along],
            Side::Right => [self.distance, down, along],
            Side::Across => [along, down, self.distance],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::street::town::{Hit, seen};

    /// Just below a roof is its façade, unless something is in front of it; just above, no façade has that height.
    #[test]
    fn lines_are_where_the_street_has_them() {
        let all = lines();
        let upright = all.iter().filter(|line| line.is_upright).count();
        assert!(upright > 10 && all.len() > upright + 10, "{upright} of {}", all.len());
        let mut hit = 0;
        for line in all.iter().filter(|line| !line.is_upright && line.ends[0][1] < CAMERA) {
            let middle: [f64; 3] =
                std::array::from_fn(|at| f64::midpoint(line.ends[0][at], line.ends[1][at]));
            let length = middle.map(|part| part * part).iter().sum::<f64>().sqrt();
            let ray = |down: f64| [middle[0] / length, (middle[1] + down) / length, middle[2] / length];
            let roof = CAMERA - middle[1];
            if let Hit::Facade { height, .. } = seen(ray(0.1)) {
                assert!((roof - height).abs() < 0.5, "{line:?}: {height}");
                hit += 1;
            }
            assert!(
                !matches!(seen(ray(-0.1)), Hit::Facade { height, .. } if (roof - height).abs() < 0.05),
                "{line:?}"
            );
        }
        assert!(hit > 10, "{hit} of the roofs are seen");
    }
}
