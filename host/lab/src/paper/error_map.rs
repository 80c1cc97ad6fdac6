//! Fig. 5: the difference between the simplified projection and the exact one (Sect. 3.2).

use halfrow_model::{Equidistant, exact, simplified};

use super::exhibit::{Accepted, Cell, Claim, Drawing, Exhibit, Picture, Table};
use super::expected::{MEAN_ERROR_TOLERANCE, MEAN_ERRORS};
use super::{Item, PaperError};
use halfrow::frames::HeatMap;

/// R in pixels.
const RADIUS: i32 = 100;

/// The rows |y| up to this one are the middle 16 : 9 part, 113 of 201.
const MIDDLE: i32 = 56;

/// The map and its two means.
pub(super) fn exhibit() -> Result<Exhibit, PaperError> {
    let lens = Equidistant::from_radius(f64::from(RADIUS))?;
    let rows: Vec<Vec<f64>> = (-RADIUS..=RADIUS)
        .map(|y| (-RADIUS..=RADIUS).map(|x| error(&lens, f64::from(x), f64::from(y))).collect())
        .collect();
    let whole = mean(&rows);
    let middle = mean(&rows[(RADIUS - MIDDLE) as usize..=(RADIUS + MIDDLE) as usize]);
    let mut exhibit = Exhibit::new(Item::Fig5);
    exhibit.remark(
        "|x_u by Eq. 6 − x_u by Eq. 8| at the whole numbers x, y = −100 … 100 with R = 100 and f = 2R/π. It is 0 outside \
         the image circle and on the rows y = ±R, where Eq. 9 has no value, and these zeros count in the means. The middle \
         part of 16 : 9 is the 113 rows |y| ≤ 56.",
    );
    let parts = ["mean error of the whole image", "mean error of the middle 16 : 9"];
    for ((what, paper), found) in parts.into_iter().zip(MEAN_ERRORS).zip([whole, middle]) {
        let (what, accepted) = (what.to_owned(), Accepted::Within(MEAN_ERROR_TOLERANCE));
        exhibit.claims.push(Claim {
            what,
            unit: "px",
            paper: Some(paper),
            found,
            accepted,
            judges_board: false,
        });
    }
    exhibit.pictures.push(picture(&rows));
    exhibit.tables.push(table(&rows));
    Ok(exhibit)
}

/// The error at the fisheye point (`x`, `y`) in pixels; 0 where one of the projections has no value.
fn error(lens: &Equidistant, x: f64, y: f64) -> f64 {
    let radius = lens.radius();
    if x * x + y * y > radius * radius || y.abs() >= radius {
        return 0.0;
    }
    (exact(lens, x, y).0 - simplified(radius, x, y).0).abs()
}

fn mean(rows: &[Vec<f64>]) -> f64 {
    let sum: f64 = rows.iter().flatten().sum();
    sum / rows.iter().map(Vec::len).sum::<usize>() as f64
}

fn picture(rows: &[Vec<f64>]) -> Picture {
    let HeatMap { image, most } = HeatMap::new(rows);
    Picture {
        name: "fig-5b".to_owned(),
        caption: format!("Fig. 5(b): the error, from 0 (dark) to {most:.2} px (bright)."),
        drawing: Drawing::Pixels(image, 3),
    }
}

fn table(rows: &[Vec<f64>]) -> Table {
    let heads = (-RADIUS..=RADIUS).map(|x| format!("x = {x}"));
    let row = |(y, errors): (i32, &Vec<f64>)| {
        let errors = errors.iter().map(|&error| Cell::Number(error, 6));
        std::iter::once(Cell::Number(f64::from(y), 0)).chain(errors).collect()
    };
    Table {
        name: "fig-5",
        caption: "The error in pixels at every point, R = 100.".to_owned(),
        columns: std::iter::once("y".to_owned()).chain(heads).collect(),
        rows: (-RADIUS..=RADIUS).zip(rows).map(row).collect(),
        on_page: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, R = 100: on the row y = 0 both projections have x_u = x_d. At (60, 60), r/f = 1.332865 rad and the longitude is
    /// atan(0.707107 · tan 1.332865) = 1.240387 rad, so Eq. 6 gives 78.9655 and Eq. 8 60 / 0.8 = 75.
    #[test]
    fn the_error_is_that_of_eqs_6_and_8() {
        let lens = Equidistant::from_radius(100.0).unwrap();
        assert!(error(&lens, 40.0, 0.0) < 1e-12);
        assert!((error(&lens, 60.0, 60.0) - 3.9655).abs() < 1e-4, "{}", error(&lens, 60.0, 60.0));
        assert_eq!((error(&lens, 80.0, 80.0), error(&lens, 0.0, 100.0)), (0.0, 0.0));
    }

    /// An independent calculation in NumPy with the same grid gave 2.3853 and 0.8021.
    #[test]
    fn the_means_are_the_paper_s() {
        let claims = exhibit().unwrap().claims;
        assert!((claims[0].found - 2.3853).abs() < 5e-5 && (claims[1].found - 0.8021).abs() < 5e-5);
        assert!(claims.iter().all(Claim::holds));
    }
}
