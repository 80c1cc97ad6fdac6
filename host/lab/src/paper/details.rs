//! Fig. 12: details of a corrected photograph, enlarged.

use halfrow_model::{Frame, Phase};

use super::exhibit::{Cell, Drawing, Exhibit, Picture, Table};
use super::expected::METHODS;
use super::experiment::Experiment;
use super::psnr::psnr;
use super::table_1::name;
use super::{Item, PaperError};
use halfrow::frames::mosaic;
use halfrow::frames::preview::{RgbImage, demosaic_coded};

/// The photograph, counted from 0: the houses, on which all methods do worst.
const PHOTOGRAPH: usize = 7;

/// Columns and rows of a detail.
const SIZE: (usize, usize) = (96, 72);

/// Details begin at multiples of this, so that they start on a whole cell of the filter array.
const GRID: usize = 24;

/// The frames around the details: yellow and blue, as in the paper.
const FRAMES: [([u8; 3], &str); 2] = [([255, 220, 0], "yellow"), ([40, 90, 255], "blue")];

/// How many times a detail is enlarged.
const ZOOM: usize = 4;

/// The upper left corner of a detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Corner {
    row: usize,
    column: usize,
}

/// The whole photograph and two details of it by each method, and the original.
pub(super) fn exhibit(photographs: &[RgbImage]) -> Result<Exhibit, PaperError> {
    let photograph = &photographs[PHOTOGRAPH];
    let experiment = Experiment::new()?;
    let trial = experiment.trial(photograph)?;
    let corrected = METHODS.map(|interpolant| experiment.by_reals(interpolant, &trial));
    let [linear, cubic, hermite] = corrected;
    let corrected = [linear?, cubic?, hermite?];
    let corners = worst(&trial.reference, &corrected[0]);
    let mut exhibit = Exhibit::new(Item::Fig12);
    exhibit.remark(format!(
        "Photograph {}; the paper does not say which it shows. All pictures are demosaicked alike, each missing colour being \
         the mean of its neighbours. The details are those where linear interpolation errs most.",
        PHOTOGRAPH + 1
    ));
    let developed = corrected.each_ref().map(demosaic_coded);
    let reference = demosaic_coded(&mosaic(photograph, Phase::Grbg)?);
    // One row for each method: the whole picture and its details.
    exhibit.in_threes = true;
    let pictures = METHODS.map(name).into_iter().zip(&developed).chain([("original", &reference)]);
    for (name, image) in pictures {
        exhibit.pictures.extend(shown(name, image, corners));
    }
    exhibit.tables.push(table(&trial.reference, &corrected, corners));
    Ok(exhibit)
}

/// The two details, not overlapping, in which `found` is farthest from `reference`.
fn worst(reference: &Frame, found: &Frame) -> [Corner; 2] {
    let (width, height) = SIZE;
    let rows = (0..=reference.height() - height).step_by(GRID);
    let places = rows.flat_map(|row| {
        (0..=reference.width() - width).step_by(GRID).map(move |column| Corner { row, column })
    });
    let mut scored: Vec<(f64, Corner)> =
        places.map(|corner| (detail_psnr(reference, found, corner), corner)).collect();
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let first = scored[0].1;
    let apart = |corner: &Corner| {
        corner.row.abs_diff(first.row) >= height || corner.column.abs_diff(first.column) >= width
    };
    let second = scored.iter().map(|(_, corner)| *corner).find(apart).unwrap_or(first);
    [first, second]
}

fn detail_psnr(reference: &Frame, found: &Frame, corner: Corner) -> f64 {
    let samples = |frame: &Frame| -> Vec<u16> {
        (corner.row..corner.row + SIZE.1)
            .flat_map(|row| frame.row(row)[corner.column..corner.column + SIZE.0].to_vec())
            .collect()
    };
    psnr(&samples(reference), &samples(found))
}

/// The whole picture with frames around its details, and the details.
fn shown(name: &str, image: &RgbImage, corners: [Corner; 2]) -> [Picture; 3] {
    let mut framed = image.clone();
    for (corner, (colour, _)) in corners.into_iter().zip(FRAMES) {
        frame(&mut framed, corner, colour);
    }
    let detail = |index: usize, Corner { row, column }: Corner| Picture {
        name: format!("fig-12-{name}-{}", FRAMES[index].1).to_lowercase(),
        caption: format!("Fig. 12, {name}: the detail in {}.", FRAMES[index].1),
        drawing: Drawing::Pixels(cut(image, (column, row), SIZE), ZOOM),
    };
    let whole = Picture {
        name: format!("fig-12-{name}").to_lowercase(),
        caption: format!("Fig. 12, {name}."),
        drawing: Drawing::Pixels(framed, 1),
    };
    [whole, detail(0, corners[0]), detail(1, corners[1])]
}

/// The part of `image` of this size whose upper left corner is at this column and row.
pub(super) fn cut(
    image: &RgbImage,
    (column, top): (usize, usize),
    (width, height): (usize, usize),
) -> RgbImage {
    let row = |row: usize| {
        let start = 3 * (row * image.width + column);
        &image.data[start..start + 3 * width]
    };
    RgbImage { width, height, data: (top..top + height).flat_map(row).copied().collect() }
}

/// Draws a line two pixels wide along the inner edge of a detail.
fn frame(image: &mut RgbImage, corner: Corner, colour: [u8; 3]) {
    let (width, height) = SIZE;
    for row in 0..height {
        for column in 0..width {
            let edge = row.min(height - 1 - row).min(column.min(width - 1 - column));
            if edge < 2 {
                let start = 3 * ((corner.row + row) * image.width + corner.column + column);
                image.data[start..start + 3].copy_from_slice(&colour);
            }
        }
    }
}

fn table(reference: &Frame, corrected: &[Frame; 3], corners: [Corner; 2]) -> Table {
    let rows = corners.into_iter().zip(FRAMES).map(|(corner, (_, colour))| {
        let scores = corrected.iter().map(|found| Cell::Number(detail_psnr(reference, found, corner), 4));
        [
            Cell::Text(colour.to_owned()),
            Cell::Number(corner.row as f64, 0),
            Cell::Number(corner.column as f64, 0),
        ]
        .into_iter()
        .chain(scores)
        .collect()
    });
    let heads = ["detail", "first row", "first column"].into_iter().chain(METHODS.map(name));
    Table {
        name: "fig-12",
        caption: format!("PSNR of the raw samples of each detail, {} x {}, in dB.", SIZE.0, SIZE.1),
        columns: heads.map(str::to_owned).collect(),
        rows: rows.collect(),
        on_page: true,
    }
}
