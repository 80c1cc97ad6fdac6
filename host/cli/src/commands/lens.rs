//! `halfrow lens`

use std::path::{Path, PathBuf};

use clap::Args;
use halfrow_model::{GridShape, INNER_DEGREES, INNER_ROWS, LONGEST_RING, VISIBLE};
use halfrow_program::files::prepare_files;
use serde_json::{Map, Value, json};

use super::{Context, Failure, print};
use crate::arguments::given::{Decider, Given};
use crate::arguments::optics::LensArguments;
use crate::console;
use crate::document::{print_result, tell_result};
use crate::exit::Exit;
use halfrow::call::refuse_stdout;
use halfrow::frames::{self, HeatMap};
use halfrow::lenses::LensContentError;
use halfrow::optics::{Optics, OpticsError, TablesBy};
use halfrow::words::{count, grouped, plain_lines, verb};
use halfrow_lab::{Amounts, Residuals};

#[derive(Debug, Args)]
#[command(mut_args(|argument| Decider::SHOWN_LENS.hides(argument)))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// Write the horizontal error that is left at each sample as a picture, dark for none
    #[arg(long, value_name = "FILE.png")]
    map: Option<PathBuf>,
    /// Replace a picture that is there
    #[arg(long, requires = "map")]
    overwrite: bool,
    #[command(flatten)]
    lens: LensArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    arguments.given.refuse_void(Decider::SHOWN_LENS, &[])?;
    if let Some(map) = &arguments.map {
        refuse_stdout("--map", map).map_err(Failure::call)?;
        frames::check_png(map).map_err(Failure::call)?;
    }
    prepare_files(
        &context.files(arguments.overwrite).reads(arguments.lens.file()).writes("--map", &arguments.map),
    )
    .map_err(Failure::call)?;
    let optics = arguments.lens.optics()?;
    let figures = Figures::of(&optics).map_err(Failure::call)?;
    let map = arguments.map.as_ref().zip(figures.used());
    let most = map.map(|(path, used)| write_map(path, &used.residuals, arguments.overwrite)).transpose()?;
    if context.json {
        let drawn = most.map(|most| json!({ "file": arguments.map.as_ref().map(|path| path.display().to_string()), "brightest_px": most }));
        let result = figures.json(drawn.as_ref());
        match drawn {
            Some(_) => tell_result("lens", result)?,
            None => print_result("lens", result)?,
        }
        return Ok(Exit::Pass);
    }
    let Some((path, most)) = arguments.map.as_ref().zip(most) else {
        print(&figures.text())?;
        return Ok(Exit::Pass);
    };
    console::tell(&figures.text());
    console::tell_line(&format!("wrote {}, from 0 (dark) to {most:.3} px (bright)", path.display()));
    Ok(Exit::Pass)
}

/// The errors that tables made in one way leave.
struct TableResiduals {
    by: TablesBy,
    /// The shape of a grid; none for row factors.
    shape: Option<GridShape>,
    residuals: Residuals,
}

/// What the command reports.
struct Figures<'a> {
    optics: &'a Optics,
    /// Eq. 9, fitted rows, and the grid.
    all: Vec<TableResiduals>,
    /// Why a board would not take the requested tables, if so.
    illegal: Option<String>,
}

impl<'a> Figures<'a> {
    fn of(optics: &'a Optics) -> Result<Self, OpticsError> {
        let exact = match optics.by {
            by @ TablesBy::Exact { .. } => by,
            _ => TablesBy::Exact { entries: TablesBy::LEAST_ENTRIES, k: None },
        };
        let (mut all, mut illegal) = (Vec::new(), None);
        for by in [TablesBy::Equation9, TablesBy::Fitting, exact] {
            let tables = optics.tables_by(by)?;
            if by == optics.by {
                optics.check_circle(&tables)?;
                illegal = tables.check_ring(LONGEST_RING).err().map(|error| match optics.file {
                    Some(_) => LensContentError::from(error).to_string(),
                    None => error.to_string(),
                });
            }
            let residuals = Residuals::of(&optics.camera, &tables);
            all.push(TableResiduals { by, shape: tables.shape(), residuals });
        }
        Ok(Self { optics, all, illegal })
    }

    /// The errors that the requested tables leave.
    fn used(&self) -> Option<&TableResiduals> {
        self.all.iter().find(|left| left.by == self.optics.by)
    }

    fn text(&self) -> String {
        let (camera, lens) = (&self.optics.camera, self.optics.camera.lens());
        let (geometry, outside) = (camera.geometry(), camera.rows_outside_circle());
        let mut lines = vec![
            self.optics.source(),
            format!(
                "frame {} x {}, axis at column {:.3}, row {:.3} (C = {})",
                geometry.width(),
                geometry.height(),
                camera.centre().0,
                camera.centre().1,
                geometry.centre2()
            ),
            format!(
                "f = {:.3} pixels, lens model valid to {:.1} degrees; image circle {:.1} degrees; {} {} outside it",
                lens.focal_length(),
                lens.widest().to_degrees(),
                camera.field_of_view().to_degrees(),
                count(outside, "row"),
                verb(outside, "lie")
            ),
        ];
        lines.extend(self.errors());
        lines.extend(self.illegal.as_ref().map(|error| format!("no board takes these tables: {error}")));
        plain_lines(lines)
    }

    /// Lines with the errors that each way leaves.
    fn errors(&self) -> Vec<String> {
        let Some(first) = self.all.first() else { return Vec::new() };
        let amounts = |Amounts { mean, max }: Amounts| format!("{mean:9.4} {max:9.4}");
        let head = format!("error left at {} samples, in pixels", grouped(first.residuals.samples));
        let mut lines = vec![format!("{head:<50} mean       max   inner max  above {VISIBLE}    rim max")];
        for left in &self.all {
            let name = left.by.how(left.shape);
            let Residuals { circle, inner, rim, .. } = &left.residuals;
            let (all, share) = (amounts(circle.amounts), 100.0 * inner.visible);
            let (inner, rim) = (inner.amounts.max, rim.amounts.max);
            lines.push(format!("  {name:<45} {all} {inner:11.4} {share:9.2} % {rim:10.4}"));
        }
        lines.push(format!(
            "  {:<45} {}",
            "vertical, whatever the tables",
            amounts(first.residuals.vertical)
        ));
        lines.push(format!(
            "inner: up to {INNER_DEGREES} degrees off the axis, and up to {INNER_ROWS} of the height of the circle of 180 degrees; \
             rim: everything else, with the poles."
        ));
        lines.push(format!(
            "above {VISIBLE}: the share of the inner part that is off by more than {VISIBLE} pixels."
        ));
        lines.push("Rows are kept (Eq. 7): level lines bend as before.".to_owned());
        lines.extend(self.beyond());
        lines.extend(self.warning());
        lines
    }

    /// A line about outputs that have no exact place, if there are any.
    fn beyond(&self) -> Option<String> {
        let camera = &self.optics.camera;
        let beyond = 100.0 * camera.share_beyond();
        let end = (10.0 * camera.lens().widest().to_degrees().min(90.0)).round() / 10.0;
        (beyond > 0.0).then(|| {
            format!(
                "{beyond:.1} % of the outputs show what lies beyond {end} degrees, which has no exact place: a grid goes on there as \
                 at the rim, above and below the poles as in the row next to them."
            )
        })
    }

    /// A line for a grid that is visibly worse than factors of rows.
    fn warning(&self) -> Option<String> {
        let fitted = self.all.iter().find(|left| left.by == TablesBy::Fitting)?.residuals.inner;
        let (exact, entries, k) = self.all.iter().find_map(|left| match left.by {
            TablesBy::Exact { entries, k } => Some((left.residuals.inner, entries, k)),
            _ => None,
        })?;
        let nodes = k.map_or_else(String::new, |k| format!(", with a node every {} columns,", 1 << k));
        let remedy = match self.optics.by {
            TablesBy::Exact { .. } => ", so use --rows fitted in place of --projection exact",
            TablesBy::Equation9 | TablesBy::Fitting => "",
        };
        (exact.visible > 0.0 && exact.amounts.max > fitted.amounts.max).then(|| {
            format!(
                "The exact projection is farther off here than fitted rows: no better grid of {entries} entries or fewer{nodes} \
                 that a board takes was found{remedy}."
            )
        })
    }

    fn json(&self, map: Option<&Value>) -> Value {
        let (camera, lens) = (&self.optics.camera, self.optics.camera.lens());
        let geometry = camera.geometry();
        let first = self.all.first().map(|left| &left.residuals);
        let of_each = |json: fn(&Residuals) -> Value| {
            let each = self.all.iter().map(|left| (left.by.name().to_owned(), json(&left.residuals)));
            each.collect::<Map<_, _>>()
        };
        let parts = |Residuals { circle, inner, rim, .. }: &Residuals| json!({ "circle": circle, "inner": inner, "rim": rim });
        let shape = self.all.iter().find_map(|left| left.shape);
        json!({
            "lens": {
                "name": self.optics.name,
                "focal_length_px": lens.focal_length(),
                "radius_px": camera.radius(),
                "widest_degrees": lens.widest().to_degrees(),
                "field_of_view_degrees": camera.field_of_view().to_degrees(),
                "pixel_height_by_width": lens.pixel_height(),
            },
            "frame": { "width": geometry.width(), "height": geometry.height() },
            "centre": { "column": camera.centre().0, "row": camera.centre().1, "centre2": geometry.centre2() },
            "rows": self.optics.by.name(),
            "grid": shape.map(|shape| json!({ "v": shape.v(), "k": shape.k(), "entries": shape.entries(geometry) })),
            "rows_outside_circle": camera.rows_outside_circle(),
            "illegal": self.illegal,
            "samples": first.map(|residuals| residuals.samples),
            "residual_px": {
                "horizontal": of_each(|left| json!(left.circle.amounts)),
                "vertical": first.map(|residuals| residuals.vertical),
                "parts": of_each(parts),
                "share_beyond_90_degrees": camera.share_beyond(),
            },
            "map": map,
        })
    }
}

/// Writes the picture, and returns the error that is shown brightest, in pixels.
fn write_map(path: &Path, residuals: &Residuals, overwrite: bool) -> Result<f64, Failure> {
    let HeatMap { image, most } = HeatMap::new(&residuals.map);
    frames::write_rgb(path, &image, overwrite).map(|()| most).map_err(Failure::error)
}
