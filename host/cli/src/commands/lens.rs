//! `halfrow lens`

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::document::print_result;
use super::files::Files;
use super::optics::LensArguments;
use super::{Context, Failure, print};
use crate::console;
use crate::exit::Exit;
use halfrow::frames::{self, HeatMap};
use halfrow::optics::{Optics, OpticsError, RowsBy};
use halfrow_lab::{Residuals, Spread};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    lens: LensArguments,
    /// Write the horizontal error that is left at each sample as a picture, dark for none
    #[arg(long, value_name = "FILE.png")]
    map: Option<PathBuf>,
    /// Replace a picture that is there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    arguments.map.as_deref().map_or(Ok(()), frames::check_png).map_err(Failure::call)?;
    Files::new(arguments.overwrite)
        .reads(&context.settings_file)
        .reads(arguments.lens.file())
        .writes("--map", &arguments.map)
        .check()
        .map_err(Failure::call)?;
    let optics = arguments.lens.optics()?;
    let figures = Figures::of(&optics).map_err(Failure::call)?;
    let most = match &arguments.map {
        None => None,
        Some(path) => Some(write_map(path, figures.used(), arguments.overwrite)?),
    };
    if context.json {
        let map = most.map(|most| json!({ "file": arguments.map.as_ref().map(|path| path.display().to_string()), "brightest_px": most }));
        print_result("lens", Exit::Pass, None, figures.json(map.as_ref()))?;
        return Ok(Exit::Pass);
    }
    print(&figures.text())?;
    if let (Some(path), Some(most)) = (&arguments.map, most) {
        console::tell(&format!("wrote {}, from 0 (dark) to {most:.3} px (bright)", path.display()));
    }
    Ok(Exit::Pass)
}

/// What there is to say.
struct Figures<'a> {
    optics: &'a Optics,
    equation_9: Residuals,
    fitted: Residuals,
    /// Why a board would not take the row factors that are asked for.
    illegal: Option<halfrow_model::TableError>,
}

impl<'a> Figures<'a> {
    fn of(optics: &'a Optics) -> Result<Self, OpticsError> {
        let (equation_9, fitted) = (optics.tables_by(RowsBy::Equation9)?, optics.tables_by(RowsBy::Fitting)?);
        let used = if optics.rows == RowsBy::Fitting { &fitted } else { &equation_9 };
        optics.check_circle(used)?;
        let illegal = used.check_ring(optics.camera.geometry().width().next_power_of_two()).err();
        let residuals = |tables| Residuals::of(&optics.camera, tables);
        Ok(Self { optics, equation_9: residuals(&equation_9), fitted: residuals(&fitted), illegal })
    }

    /// What the row factors leave that are asked for.
    fn used(&self) -> &Residuals {
        if self.optics.rows == RowsBy::Fitting { &self.fitted } else { &self.equation_9 }
    }

    fn text(&self) -> String {
        let (camera, lens) = (&self.optics.camera, self.optics.camera.lens());
        let geometry = camera.geometry();
        let amounts = |Spread { mean, max }: Spread| format!("{mean:9.4} {max:9.4}");
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
                "f = {:.3} pixels, r rises up to {:.1} degrees, image circle {:.1} degrees across, {} rows outside of it",
                lens.focal_length(),
                lens.widest().to_degrees(),
                camera.field_of_view().to_degrees(),
                camera.rows_outside_circle()
            ),
            format!("error left at {} samples, in pixels     mean       max", self.fitted.samples),
            format!("  horizontal, Eq. 9               {}", amounts(self.equation_9.horizontal)),
            format!("  horizontal, fitted rows         {}", amounts(self.fitted.horizontal)),
            format!("  vertical, whatever the rows     {}", amounts(self.fitted.vertical)),
        ];
        lines.extend(self.illegal.as_ref().map(|error| format!("no board takes these rows: {error}")));
        lines.join("\n")
    }

    fn json(&self, map: Option<&Value>) -> Value {
        let (camera, lens) = (&self.optics.camera, self.optics.camera.lens());
        let geometry = camera.geometry();
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
            "rows": self.optics.rows.name(),
            "rows_outside_circle": camera.rows_outside_circle(),
            "illegal": self.illegal.as_ref().map(ToString::to_string),
            "samples": self.fitted.samples,
            "residual_px": {
                "horizontal": { "equation-9": self.equation_9.horizontal, "fitted": self.fitted.horizontal },
                "vertical": self.fitted.vertical,
            },
            "map": map,
        })
    }
}

/// Writes the picture and returns the error that is brightest in it, in pixels.
fn write_map(path: &Path, residuals: &Residuals, overwrite: bool) -> Result<f64, Failure> {
    let HeatMap { image, most } = HeatMap::new(&residuals.map);
    frames::write_rgb(path, &image, overwrite).map(|()| most).map_err(Failure::error)
}
