//! The delay claimed in Sect. 4.2, half a row, measured on a board.

use std::ops::RangeInclusive;
use std::sync::Arc;

use halfrow_model::{Equidistant, Geometry, Interpolant, Kernel, TableSet};

use super::exhibit::{Accepted, Cell, Claim, Exhibit, Table};
use super::expected::DELAY_MS;
use super::tested_board::TestedBoard;
use super::{Item, PaperError};
use halfrow::board::MAX_LATENCY;
use halfrow::frames::{Builtin, Scene};
use halfrow::progress::Progress;

/// Pixel clocks a second, and where they come from.
const CLOCKS: [(f64, &str); 2] = [
    (1920.0 * 1080.0 * 30.0, "1920 x 1080 x 30 Hz without any blanking, the slowest that carries 1080p30"),
    (96e6, "MT9P031 at its fastest"),
];

/// Streams one frame of 1080p and compares the delay that the board measured with the paper's.
pub(super) fn exhibit(board: &mut TestedBoard, progress: &dyn Progress) -> Result<Exhibit, PaperError> {
    let geometry = Geometry::default();
    let tables = TableSet::from_lens(geometry, &Equidistant::default(), None)?;
    let frame = Arc::new(Builtin::Noise.render(&Scene::default())?);
    let kernel = Kernel::from(Interpolant::Hermite);
    let latency = board.correct(&tables, &kernel, &[frame], progress)?.latency;
    let mut exhibit = Exhibit::new(Item::Delay);
    exhibit.remark(format!(
        "The {} counted the pixel clocks from a row's first sample in to its first out, and from last to last, for each of {} \
         rows: {} at least, {} at most; half a row is {}.",
        board.name(),
        geometry.height(),
        latency.start(),
        latency.end(),
        geometry.width() / 2
    ));
    let half_row = geometry.width() as u16 / 2;
    let advertised = half_row + board.advertised_latency();
    exhibit.claims.extend(claims(&latency, half_row, advertised));
    exhibit.tables.push(table(f64::from(*latency.end())));
    Ok(exhibit)
}

/// The limits for the measured pixel clocks.
fn claims(latency: &RangeInclusive<u16>, half_row: u16, advertised: u16) -> [Claim; 3] {
    let judged = |what: &str, unit, found, accepted| Claim {
        what: what.to_owned(),
        unit,
        paper: None,
        found,
        accepted,
        judges_board: true,
    };
    let most = f64::from(*latency.end());
    let apart = latency.start().abs_diff(advertised).max(latency.end().abs_diff(advertised));
    [
        judged(
            "longest delay of a sample, in pixel clocks",
            "",
            most,
            Accepted::UpTo((half_row + u16::from(MAX_LATENCY)).into()),
        ),
        judged(
            "the same in time, at the slowest pixel clock of 1080p30",
            "ms",
            1000.0 * most / CLOCKS[0].0,
            Accepted::Below(DELAY_MS),
        ),
        judged(
            "pixel clocks between a delay that was measured and the one that the board advertises",
            "",
            apart.into(),
            Accepted::UpTo(0.0),
        ),
    ]
}

fn table(clocks: f64) -> Table {
    let row = |(frequency, origin): (f64, &str)| {
        vec![
            Cell::Text(origin.to_owned()),
            Cell::Number(frequency / 1e6, 3),
            Cell::Number(clocks, 0),
            Cell::Number(1000.0 * clocks / frequency, 5),
        ]
    };
    let columns = ["pixel clock", "MHz", "delay, clocks", "delay, ms"];
    Table {
        name: "delay",
        caption: "The longest delay in time.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: CLOCKS.into_iter().map(row).collect(),
        on_page: true,
    }
}
