//! From a lens or a table file to what a board is judged with.
//!
//! ```text
//!  lens file ──► Optics ──► tables ──────┐
//!  table file ───────────────────────────┼─► Chosen ─► Plan
//!  kernel's name or file ────────────────┘
//! ```

mod error;
mod view;

use std::f64::consts::FRAC_PI_2;
use std::ffi::OsStr;
use std::path::Path;

use halfrow_model::{
    Camera, Equidistant, GridShape, Interpolant, Kernel, LONGEST_RING, LensError, Phase, RowFactor,
    TableError, TableSet,
};

pub use error::OpticsError;
use error::circle;
pub use view::View;

use crate::call::Input;
use crate::frames::Scene;
use crate::kernels::NamedKernel;
use crate::lenses::LensModel;
use crate::run::Plan;
use crate::tables::{KernelFile, TableFile, TableFileError};

/// The paper's frame, columns and rows.
pub const PAPER_SIZE: (usize, usize) = (1920, 1080);
/// The paper's image circle, in degrees.
pub const PAPER_FIELD: f64 = 180.0;

/// The prefix that names an equidistant lens in place of a lens file. R in pixels follows.
pub const EQUIDISTANT: &str = "equidistant:";

/// How tables are computed from a lens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TablesBy {
    /// For each row the factor whose largest error is smallest.
    Fitting,
    /// For each row the factor of the paper's formula.
    Equation9,
    /// A grid of factors that follows the exact projection (DATAPATH.md, *Datapath 2*).
    Exact {
        /// The most entries that it may have: T of the board.
        entries: usize,
        /// Its k; none for the one that suits the lens, on a board that takes both.
        k: Option<u32>,
    },
}

impl TablesBy {
    /// The entries that every board with datapath 2 has room for.
    pub const LEAST_ENTRIES: usize = crate::board::LEAST_ENTRIES as usize;

    /// Its name: stable, lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fitting => "fitted",
            Self::Equation9 => "equation-9",
            Self::Exact { .. } => "exact",
        }
    }

    /// How tables were found, for people; `shape` is the shape of a grid.
    #[must_use]
    pub fn how(self, shape: Option<GridShape>) -> String {
        let how = match self {
            Self::Fitting => "fitted rows",
            Self::Equation9 => "Eq. 9",
            Self::Exact { .. } => "exact projection",
        };
        shape.map_or_else(|| how.to_owned(), |shape| format!("{how}, {shape}"))
    }
}

/// What `tables` of a lens do with rows outside its image circle, to follow the subject of a sentence. A grid goes on beyond 90
/// degrees, where the exact projection ends.
#[must_use]
pub fn outside_circle(tables: &TableSet) -> &'static str {
    match tables.shape() {
        None => "not stretched",
        Some(_) => "stretched by the grid, beyond 90 degrees as the row next to the pole is, and not exactly",
    }
}

/// A lens and the frames that it images.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Both of them, and where the axis is.
    pub camera: Camera,
    /// The equidistant lens through which built-in frames are rendered: that of `camera`, or one that images 90 degrees where
    /// that one does. If it does not reach so far, they have the edge of the image circle in common.
    pub lens: Equidistant,
    /// The row of the axis; none for the middle.
    pub centre_y: Option<f64>,
    /// How its tables are found.
    pub by: TablesBy,
    /// What the lens is, for people.
    pub name: String,
    /// The file that describes it; none for an equidistant lens.
    pub file: Option<Input>,
}

impl Optics {
    /// An equidistant lens, with its axis in row `centre_y` of the frames of `camera`, or in their middle.
    fn equidistant(camera: Camera, lens: Equidistant, centre_y: Option<f64>, by: TablesBy) -> Self {
        let name = "equidistant lens".to_owned();
        Self { camera, lens, centre_y, by, name, file: None }
    }

    /// The calibrated lens of `camera`, of the kind `model`, as `file` describes it. An error when built-in frames cannot be
    /// rendered through a lens of its size.
    fn calibrated(camera: Camera, model: LensModel, file: Input, by: TablesBy) -> Result<Self, LensError> {
        let (angle, radius) = hemisphere(&camera);
        Ok(Self {
            lens: Equidistant::from_radius(radius * (FRAC_PI_2 / angle))?,
            centre_y: Some(camera.centre().1),
            camera,
            by,
            name: format!("{model} {}", file.path.display()),
            file: Some(file),
        })
    }

    /// What built-in frames are rendered for.
    #[must_use]
    pub fn scene(&self, phase: Phase, seed: u64) -> Scene {
        let (geometry, centre_y, lens) = (*self.camera.geometry(), self.centre_y, self.lens);
        Scene { geometry, centre_y, phase, lens, seed }
    }

    /// The tables, found as `by` of this lens says.
    ///
    /// # Errors
    /// [`OpticsError`] like [`Self::tables_by`].
    pub fn tables(&self) -> Result<TableSet, OpticsError> {
        self.tables_by(self.by)
    }

    /// The tables, found as `by` says.
    ///
    /// # Errors
    /// [`OpticsError`] when no board can have one of the factors, or a grid needs more entries than allowed.
    pub fn tables_by(&self, by: TablesBy) -> Result<TableSet, OpticsError> {
        Ok(match by {
            TablesBy::Exact { entries, k: None } => self.camera.best_grid(entries)?,
            TablesBy::Exact { entries, k: Some(k) } => self.camera.best_grid_with_k(k, entries)?,
            TablesBy::Fitting => self.camera.fitted(),
            TablesBy::Equation9 if self.file.is_some() => self.camera.equation_9(),
            // From R as it was given. The camera would compute it from f.
            TablesBy::Equation9 => TableSet::from_lens(*self.camera.geometry(), &self.lens, self.centre_y)?,
        })
    }

    /// Refuses `tables` of this lens that stretch nothing, or nothing that the lens images, since its image circle misses the
    /// rows. Warns if it misses most of them.
    ///
    /// # Errors
    /// [`OpticsError::OutsideCircle`]
    pub fn check_circle(&self, tables: &TableSet) -> Result<(), OpticsError> {
        let (rows, outside) = (self.camera.geometry().height(), self.rows_outside_circle(tables));
        let (radius, centre) = (self.circle_radius(tables), self.camera.centre().1);
        let stretches = outside < rows && tables.entries().any(|entry| entry != RowFactor::ONE.get());
        if outside > 0 && !stretches {
            return Err(OpticsError::OutsideCircle { outside, rows, radius, centre });
        }
        if 2 * outside > rows {
            tracing::warn!(
                "{}, and are {}; check the lens, its centre and the size of the frames",
                circle(outside, rows, radius, centre),
                outside_circle(tables)
            );
        }
        Ok(())
    }

    /// The radius of the circle in which `tables` of this lens correct, in pixel widths: the lens's own, or for a grid, which
    /// follows the exact projection whatever the lens's field of view is, that of 180 degrees.
    fn circle_radius(&self, tables: &TableSet) -> f64 {
        match tables.shape() {
            None => self.camera.radius(),
            Some(_) => self.camera.hemisphere_height() * self.camera.lens().pixel_height(),
        }
    }

    /// How many rows lie outside the circle in which `tables` of this lens correct.
    fn rows_outside_circle(&self, tables: &TableSet) -> usize {
        match tables.shape() {
            None => self.camera.rows_outside_circle(),
            Some(_) => self.camera.rows_outside_hemisphere(),
        }
    }

    /// A sentence on where `tables`, made for this lens, come from.
    #[must_use]
    pub fn source_of(&self, tables: &TableSet) -> String {
        let source = match tables.shape() {
            None => self.source(),
            // It goes to 90 degrees for every field of view.
            Some(_) => self.source_with(hemisphere(&self.camera)),
        };
        format!("{source} ({})", self.by.how(tables.shape()))
    }

    /// A sentence on what the lens is.
    #[must_use]
    pub fn source(&self) -> String {
        self.source_with((self.camera.field_of_view() / 2.0, self.camera.radius()))
    }

    /// The same, with R at this angle, in radians.
    fn source_with(&self, (angle, radius): (f64, f64)) -> String {
        // Without what the conversion to radians and back added.
        let degrees = (angle.to_degrees() * 1e9).round() / 1e9;
        // 90 degrees is the angle that R means in Eq. 9, and on every page.
        let of_angle = if degrees == 90.0 { String::new() } else { format!(" at {degrees} degrees") };
        format!("{}, R = {radius:.3} pixels{of_angle}", self.name)
    }
}

/// 90 degrees, in radians, and where the lens of `camera` images them, in pixels; of a lens that does not reach so far, the edge
/// of the image circle.
fn hemisphere(camera: &Camera) -> (f64, f64) {
    let reached = camera.lens().column(FRAC_PI_2).map(|radius| (FRAC_PI_2, radius));
    reached.unwrap_or((camera.field_of_view() / 2.0, camera.radius()))
}

/// A kernel by its name, or from a kernel file.
///
/// # Errors
/// [`OpticsError`] when it is neither, or a file that cannot be used.
pub fn kernel(name: &OsStr) -> Result<Kernel, OpticsError> {
    kernel_file(name).map(|(file, _)| file.kernel)
}

/// The kernel file of this name, and what it was read from. For a named kernel it has no notes, and nothing was read.
///
/// # Errors
/// Like [`kernel`].
pub fn kernel_file(name: &OsStr) -> Result<(KernelFile, Option<Input>), OpticsError> {
    match name.to_string_lossy().parse::<NamedKernel>() {
        Ok(named) => Ok((KernelFile { kernel: named.kernel()?, about: None }, None)),
        // What may not be looked at may be there: reading it says why it cannot be.
        Err(unknown) if matches!(Path::new(name).try_exists(), Ok(false)) => {
            Err(OpticsError::Kernel { name: name.display().to_string(), unknown })
        }
        Err(_) => {
            let (file, input) = KernelFile::read(Path::new(name))?;
            Ok((file, Some(input)))
        }
    }
}

/// Tables and kernel, and where they come from.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The lens through which built-in frames are rendered, whether or not the tables are its own.
    pub optics: Optics,
    /// The row factors, or the grid.
    pub tables: TableSet,
    /// The kernel.
    pub kernel: Kernel,
    /// The kernel file that was named, if one was.
    pub kernel_file: Option<Input>,
    /// Where both come from, for people.
    pub source: String,
    /// Rows outside the lens's image circle; none for a table file, which does not name them.
    pub rows_outside_circle: Option<usize>,
}

impl Chosen {
    /// A plan that judges with these, once each, the built-in frames of Bayer `phase` as the lens images them.
    #[must_use]
    pub fn plan(self, phase: Phase) -> Plan {
        Plan {
            lens: self.optics.lens,
            centre_y: self.optics.centre_y,
            phase,
            tables_source: self.source,
            rows_outside_circle: self.rows_outside_circle,
            ..Plan::new(self.tables, self.kernel)
        }
    }
}

/// Takes the tables from `file` if there is one, otherwise those of the lens. `kernel_name` replaces the file's kernel, or the
/// default, Hermite.
///
/// # Errors
/// [`OpticsError`] when the kernel or the tables cannot be made, or no board takes them.
pub fn choose(
    file: Option<(&Path, TableFile)>,
    optics: Optics,
    kernel_name: Option<&OsStr>,
) -> Result<Chosen, OpticsError> {
    let path = file.as_ref().map(|(path, _)| *path);
    let chosen = unchecked(file, optics, kernel_name)?;
    // The model needs legal tables too: its paths agree only on grids that some board takes.
    let served = chosen.tables.check_ring(LONGEST_RING);
    served.map_err(|source| whose(source, path, &chosen.optics))?;
    Ok(chosen)
}

/// `source` as an error of the table file or the lens file, if there is one.
fn whose(source: TableError, tables: Option<&Path>, optics: &Optics) -> OpticsError {
    match (tables, &optics.file) {
        (Some(path), _) => TableFileError::Content { path: path.to_owned(), source: source.into() }.into(),
        (None, Some(lens)) => OpticsError::Unfit { path: lens.path.clone(), source: source.into() },
        (None, None) => source.into(),
    }
}

fn unchecked(
    file: Option<(&Path, TableFile)>,
    optics: Optics,
    kernel_name: Option<&OsStr>,
) -> Result<Chosen, OpticsError> {
    let (named, kernel_file) = match kernel_name.map(kernel_file).transpose()? {
        Some((named, input)) => (Some(named.kernel), input),
        None => (None, None),
    };
    let kernel_name = kernel_name.map(OsStr::to_string_lossy);
    let Some((path, file)) = file else {
        let tables = optics.tables()?;
        let from = optics.source_of(&tables);
        optics.check_circle(&tables)?;
        let name = kernel_name.as_deref().unwrap_or(Interpolant::Hermite.name());
        let kernel = named.unwrap_or_else(|| Kernel::from(Interpolant::Hermite));
        let rows_outside_circle = Some(optics.rows_outside_circle(&tables));
        let source = format!("{from}, {name} kernel");
        return Ok(Chosen { optics, tables, kernel, kernel_file, source, rows_outside_circle });
    };
    let mut source = path.display().to_string();
    if let Some(name) = kernel_name {
        source = format!("{source}, {name} kernel");
    }
    let kernel = named.unwrap_or(file.kernel);
    Ok(Chosen { optics, tables: file.tables, kernel, kernel_file, source, rows_outside_circle: None })
}
