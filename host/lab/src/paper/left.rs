//! What each way of making tables leaves of the exact projection, by lens, frame and optical centre.

use halfrow::frames::parallel;
use halfrow::optics::{PAPER_SIZE, TablesBy};
use halfrow::words::grouped;
use halfrow_model::{
    Camera, CameraError, Equidistant, GridResidual, GridResiduals, INNER_DEGREES, INNER_ROWS, VISIBLE,
};

use super::cameras::{self, DSL215, FISHEYE_MODEL, PAPER, SENSOR};
use super::exhibit::{Accepted, Cell, Claim, Exhibit, Table};
use super::ways::Way;
use super::{Item, PaperError};

/// Entries of the smallest bank that a board with grids may have, and of the bank for the full sensor.
const BANK: usize = TablesBy::LEAST_ENTRIES;
const LARGE_BANK: usize = 4096;

/// A lens and a frame.
struct Case {
    lens: &'static str,
    camera: fn() -> Result<Camera, CameraError>,
    /// The most entries of its grid.
    entries: usize,
    /// The largest error in the inner picture of a grid made by formula instead of being fitted. It was computed separately, in
    /// Python.
    by_formula: f64,
}

const CASES: [Case; 11] = [
    case(PAPER, || cameras::paper(PAPER_SIZE), BANK, 0.0013),
    case("a lens with R = 960", || cameras::equidistant(PAPER_SIZE, 960.0, (959.5, 539.5)), BANK, 0.0099),
    case(PAPER, || aside(PAPER_SIZE, (640.0, 360.0)), BANK, 0.0028),
    case(PAPER, || aside(PAPER_SIZE, (0.0, 0.0)), BANK, 0.064),
    case(DSL215, || cameras::dsl215_before(PAPER_SIZE), BANK, 0.0063),
    case(DSL215, || cameras::dsl215_aside(PAPER_SIZE), BANK, 0.0063),
    case(DSL215, cameras::measured, BANK, 0.024),
    case(FISHEYE_MODEL, cameras::fisheye_model, BANK, 0.0019),
    case(PAPER, || cameras::paper(SENSOR), LARGE_BANK, 0.036),
    case(PAPER, || aside(SENSOR, (900.0, 700.0)), LARGE_BANK, 0.048),
    case(DSL215, || cameras::dsl215_before(SENSOR), LARGE_BANK, 0.09),
];

const fn case(
    lens: &'static str,
    camera: fn() -> Result<Camera, CameraError>,
    entries: usize,
    by_formula: f64,
) -> Case {
    Case { lens, camera, entries, by_formula }
}

/// The paper's lens with its axis at `centre`.
fn aside(size: (usize, usize), centre: (f64, f64)) -> Result<Camera, CameraError> {
    cameras::equidistant(size, Equidistant::default().radius(), centre)
}

/// The table, and the largest errors of the exact projection compared with values computed elsewhere.
pub(super) fn exhibit() -> Result<Exhibit, PaperError> {
    let mut exhibit = Exhibit::new(Item::Residuals);
    exhibit.remark(format!(
        "How many columns of the fisheye picture an output is taken from beside its place in the exact projection (Eqs. 5 to 7), \
         at every output. The inner picture is what is up to {INNER_DEGREES}° off the axis and within {INNER_ROWS} of the image circle's \
         height; the rim is the rest of the circle, the poles among it. What is beyond 90° has no place in the exact \
         projection: a grid goes on there as at the rim, above and below the poles as in the row next to them.",
    ));
    exhibit.remark(format!(
        "A grid is the best of at most {} entries, which every board with datapath 2 has room for, and of {} for the full \
         sensor. It is accepted when its largest error in the inner picture is not above that of a grid by formula, which was \
         computed elsewhere.",
        grouped(BANK),
        grouped(LARGE_BANK)
    ));
    let (mut ways, mut parts) = (Vec::new(), Vec::new());
    let all = parallel::map(&CASES, |_, case| CaseResiduals::of(case));
    let all = all.into_iter().collect::<Result<Vec<_>, _>>()?;
    for (case, left) in CASES.iter().zip(&all) {
        exhibit.claims.push(claim(case, left));
        ways.push(left.ways());
        parts.push(left.parts());
    }
    exhibit.tables.push(table(
        "residuals",
        "The largest error in the inner picture, in pixels.",
        &WAYS,
        ways,
    ));
    exhibit.tables.push(table(
        "residuals-exact",
        "What the exact projection leaves, in pixels.",
        &parts_columns(),
        parts,
    ));
    Ok(exhibit)
}

const WAYS: [&str; 8] =
    ["lens", "frame", "axis at", "Eq. 9", "fitted rows", "exact projection", "v, k", "entries"];

fn parts_columns() -> [String; 10] {
    let (inner, rim) = (format!("above {VISIBLE}"), format!("rim above {VISIBLE}"));
    [
        "lens",
        "frame",
        "axis at",
        "inner mean",
        "largest",
        &inner,
        "rim mean",
        "rim largest",
        &rim,
        "beyond 90°",
    ]
    .map(str::to_owned)
}

/// What each way leaves in one case.
struct CaseResiduals {
    /// Lens, frame and axis.
    what: [String; 3],
    equation_9: GridResiduals,
    fitted: GridResiduals,
    exact: GridResiduals,
    /// v and k of the grid.
    shape: String,
    entries: usize,
}

impl CaseResiduals {
    fn of(case: &Case) -> Result<Self, PaperError> {
        let camera = (case.camera)()?;
        let (geometry, (column, row)) = (camera.geometry(), camera.centre());
        let [equation_9, fitted, grid] = Way::ALL.map(|way| way.tables(&camera, case.entries));
        let grid = grid?;
        let [equation_9, fitted, exact] = camera.each_grid_residuals([&equation_9?, &fitted?, &grid], 1);
        Ok(Self {
            what: [
                case.lens.to_owned(),
                format!("{} x {}", geometry.width(), geometry.height()),
                format!("{column:.1}, {row:.1}"),
            ],
            equation_9,
            fitted,
            shape: grid.shape().map_or_else(String::new, |shape| format!("{}, {}", shape.v(), shape.k())),
            entries: grid.entries().len(),
            exact,
        })
    }

    fn head(&self) -> impl Iterator<Item = Cell> {
        self.what.iter().cloned().map(Cell::Text)
    }

    fn ways(&self) -> Vec<Cell> {
        let rest = [
            Cell::Number(self.equation_9.inner.max, 1),
            Cell::Number(self.fitted.inner.max, 1),
            Cell::Number(self.exact.inner.max, 4),
            Cell::Text(self.shape.clone()),
            Cell::Number(self.entries as f64, 0),
        ];
        self.head().chain(rest).collect()
    }

    fn parts(&self) -> Vec<Cell> {
        let amounts = |GridResidual { mean, max, share }: GridResidual| {
            [Cell::Number(mean, 4), Cell::Number(max, 4), percent(share)]
        };
        let GridResiduals { inner, rim, beyond, .. } = self.exact;
        self.head().chain(amounts(inner)).chain(amounts(rim)).chain([percent(beyond)]).collect()
    }
}

fn percent(share: f64) -> Cell {
    Cell::Text(format!("{:.2} %", 100.0 * share))
}

fn claim(case: &Case, left: &CaseResiduals) -> Claim {
    let [lens, frame, axis] = &left.what;
    Claim {
        what: format!("largest in the inner picture, {lens}, {frame}, axis at {axis}"),
        unit: "px",
        paper: None,
        found: left.exact.inner.max,
        accepted: Accepted::UpTo(case.by_formula),
        judges_board: false,
    }
}

fn table(name: &'static str, caption: &str, columns: &[impl ToString], rows: Vec<Vec<Cell>>) -> Table {
    let columns = columns.iter().map(ToString::to_string).collect();
    Table { name, caption: caption.to_owned(), columns, rows, on_page: true }
}
