//! The options of geometry, lens and kernel, which several commands share.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use clap::builder::{OsStringValueParser, TypedValueParser as _};
use clap::{Args, ValueEnum};
use halfrow_model::{BitDepth, Equidistant, Geometry, GridShape, LensError, Phase};
use halfrow_program::choice::one_of;
use halfrow_program::number::any;

use crate::call_error::CallError;
use crate::failure::Failure;
use halfrow::kernels;
use halfrow::lenses::LensFile;

use super::table_file::NamedTables;
use halfrow::optics::{self, Chosen, EQUIDISTANT, Optics, OpticsError, PAPER_FIELD, TablesBy, View};

/// The pixel pitch of the paper's sensor, in micrometres.
const DEFAULT_PITCH: f64 = 2.2;

/// The size and depth of frames, the lens, and the optical centre. The defaults are the paper's system.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Frame and lens")]
pub(crate) struct LensArguments {
    /// Columns, even, 64 to 2592 [default: 1920, or those of the lens file's pictures]
    #[arg(long, value_name = "SAMPLES")]
    #[arg(value_parser = any::<usize>("a whole number of samples"))]
    width: Option<usize>,
    /// Rows, 1 to 2048 [default: 1080, or those of the lens file's pictures]
    #[arg(long, value_name = "ROWS")]
    #[arg(value_parser = any::<usize>("a whole number of rows"))]
    height: Option<usize>,
    /// Bits a sample: 8, 10 or 12
    #[arg(long, default_value = "12", hide_possible_values = true)]
    #[arg(value_parser = one_of(["8", "10", "12"], depth))]
    bits: BitDepth,
    /// Bayer phase: grbg, rggb, bggr or gbrg
    #[arg(long, default_value_t = Phase::Grbg, hide_possible_values = true)]
    #[arg(value_parser = one_of(Phase::ALL.map(Phase::name), Phase::from_str))]
    pub(crate) phase: Phase,
    /// The lens: a file of OpenCV's fisheye model (FileStorage, camera_info, camchain) or of OCamCalib, or equidistant:RADIUS
    #[arg(long, value_name = "FILE|equidistant:RADIUS")]
    #[arg(value_parser = OsStringValueParser::new().try_map(LensName::read))]
    #[arg(conflicts_with_all = ["radius", "focal_length"])]
    lens: Option<LensName>,
    /// Distance between two pixels of the camera that the lens file was made with, in micrometres: only the lens is then taken
    /// from the file, scaled to --pixel-pitch, with its axis in the middle of the frame
    #[arg(long, value_name = "UM")]
    #[arg(value_parser = any::<f64>("a number of micrometres"))]
    lens_pitch: Option<f64>,
    /// How the row factors are found [default: fitted for a lens file, equation-9 otherwise]
    #[arg(long, value_enum)]
    rows: Option<Rows>,
    /// The projection that the tables follow: by rows, with one factor each, or exact, by a grid of factors, for boards with
    /// datapath 2 [default: rows]
    #[arg(long, value_enum)]
    projection: Option<Projection>,
    /// The most entries that a grid may have: what the board has room for [default: 2048, for which every board has room]
    #[arg(long, value_name = "ENTRIES", requires = "projection")]
    #[arg(value_parser = any::<usize>("a whole number of entries"))]
    entries: Option<usize>,
    /// Columns from one node of a grid to the next, for a board that takes only 32 or only 64 [default: what suits the lens]
    #[arg(long, value_name = "32|64", requires = "projection", hide_possible_values = true)]
    #[arg(value_parser = one_of(["32", "64"], k_of_nodes))]
    nodes_every: Option<u32>,
    /// Radius of the image of 180 degrees, in pixels, instead of focal length and pixel pitch
    #[arg(long, value_name = "PIXELS", conflicts_with_all = ["focal_length", "pixel_pitch", "field_of_view"])]
    #[arg(value_parser = any::<f64>("a number of pixels"))]
    radius: Option<f64>,
    /// Focal length of the lens, in millimetres
    #[arg(long, default_value_t = 1.55, value_name = "MM")]
    #[arg(value_parser = any::<f64>("a number of millimetres"))]
    focal_length: f64,
    /// Distance between two pixels, in micrometres [default: 2.2]
    #[arg(long, value_name = "UM")]
    #[arg(value_parser = any::<f64>("a number of micrometres"))]
    pixel_pitch: Option<f64>,
    /// Angle that the image circle spans in Eq. 9, in degrees. Leave it at 180 unless you reproduce the paper: any other angle makes
    /// verticals less straight. Fitted rows are fitted to what is inside the circle [default: 180]
    #[arg(long, value_name = "DEGREES")]
    #[arg(value_parser = any::<f64>("a number of degrees"))]
    field_of_view: Option<f64>,
    /// Column of the optical centre, which a board takes to half a column [default: the lens file's, or the middle]
    #[arg(long, value_name = "COLUMN")]
    #[arg(value_parser = any::<f64>("a column, such as 319.5"))]
    centre_x: Option<f64>,
    /// Row of the optical centre [default: the lens file's, or the middle]
    #[arg(long, value_name = "ROW")]
    #[arg(value_parser = any::<f64>("a row, such as 239.5"))]
    centre_y: Option<f64>,
}

/// A lens as it is named on the command line.
#[derive(Clone, Debug)]
enum LensName {
    Equidistant(f64),
    File(PathBuf),
}

impl LensName {
    fn read(text: OsString) -> Result<Self, String> {
        match text.to_str().and_then(|text| text.strip_prefix(EQUIDISTANT)) {
            None => Ok(Self::File(PathBuf::from(text))),
            Some(radius) => radius.parse().map(Self::Equidistant).map_err(|_| {
                format!("{EQUIDISTANT} takes the radius of the image of 180 degrees, in pixels")
            }),
        }
    }
}

/// How row factors are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Rows {
    /// For every row the factor with the smallest largest error
    Fitted,
    /// The paper's formula
    #[value(name = "equation-9")]
    Equation9,
}

impl From<Rows> for TablesBy {
    fn from(rows: Rows) -> Self {
        match rows {
            Rows::Fitted => Self::Fitting,
            Rows::Equation9 => Self::Equation9,
        }
    }
}

/// What tables follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Projection {
    /// One factor a row, as --rows says
    Rows,
    /// Eqs. 5 to 7, by a grid of factors
    Exact,
}

fn depth(text: &str) -> Result<BitDepth, String> {
    text.parse().ok().and_then(BitDepth::from_bits).ok_or_else(|| "a sample has 8, 10 or 12 bits".to_owned())
}

/// k of a grid with a node every so many columns.
fn k_of_nodes(text: &str) -> Result<u32, String> {
    let k = text.parse().ok().and_then(GridShape::k_of);
    k.ok_or_else(|| "a grid has a node every 32 or every 64 columns".to_owned())
}

impl LensArguments {
    /// The file that describes the lens, if one does.
    pub(crate) fn file(&self) -> Option<&Path> {
        match &self.lens {
            Some(LensName::File(path)) => Some(path),
            _ => None,
        }
    }

    /// Whether the option `id`, one of [`super::given::IN_TABLE_FILES`], agrees with `geometry`.
    pub(crate) fn agrees(&self, id: &str, geometry: &Geometry) -> bool {
        match id {
            "width" => self.width == Some(geometry.width()),
            "height" => self.height == Some(geometry.height()),
            "bits" => self.bits == geometry.depth(),
            _ => self.centre_x.is_some_and(|column| geometry.with_centre(column).as_ref() == Ok(geometry)),
        }
    }

    /// How tables are made.
    fn by(&self, otherwise: Rows) -> TablesBy {
        match self.projection {
            Some(Projection::Exact) => {
                let entries = self.entries.unwrap_or(TablesBy::LEAST_ENTRIES);
                TablesBy::Exact { entries, k: self.nodes_every }
            }
            Some(Projection::Rows) | None => self.rows.unwrap_or(otherwise).into(),
        }
    }

    /// The frame's geometry and its lens.
    pub(crate) fn optics(&self) -> Result<Optics, Failure> {
        self.check().map_err(Failure::call)?;
        match self.file() {
            Some(path) => self.calibrated(path),
            None => self.equidistant(),
        }
        .map_err(Failure::call)
    }

    /// Refuses options that have no effect with this lens or contradict it.
    fn check(&self) -> Result<(), CallError> {
        let scales = self.lens_pitch.is_some();
        let is_exact = self.projection == Some(Projection::Exact);
        if is_exact && self.rows.is_some() {
            return Err(CallError::RowsOfGrid);
        }
        if !is_exact && (self.entries.is_some() || self.nodes_every.is_some()) {
            return Err(CallError::EntriesOfRows);
        }
        match self.lens {
            Some(LensName::File(_)) if self.pixel_pitch.is_some() && !scales => Err(CallError::PitchAlone),
            None | Some(LensName::Equidistant(_)) if scales => Err(CallError::LensPitchWithoutFile),
            Some(LensName::Equidistant(_)) if self.pixel_pitch.is_some() || self.field_of_view.is_some() => {
                Err(CallError::RadiusTwice)
            }
            _ => Ok(()),
        }
    }

    /// Refuses an angle across the image circle for `what`, in which it only limits how far the lens of a file must reach.
    pub(crate) fn refuse_field_of_view(&self, what: &'static str) -> Result<(), Failure> {
        match self.field_of_view {
            Some(_) if self.file().is_none() => Err(Failure::call(CallError::FieldOfViewVoid { what })),
            _ => Ok(()),
        }
    }

    fn pixel_pitch(&self) -> f64 {
        self.pixel_pitch.unwrap_or(DEFAULT_PITCH)
    }

    fn field_of_view(&self) -> f64 {
        self.field_of_view.unwrap_or(PAPER_FIELD)
    }

    fn equidistant(&self) -> anyhow::Result<Optics> {
        let radius = match self.lens {
            Some(LensName::Equidistant(radius)) => Some(radius),
            _ => self.radius,
        };
        let lens = match radius {
            Some(radius) => Equidistant::from_radius(radius)?,
            None => {
                Equidistant::from_focal_length(self.focal_length, self.pixel_pitch(), self.field_of_view())?
            }
        };
        Ok(Optics::of_equidistant(lens, &self.view(), self.by(Rows::Equation9))?)
    }

    fn view(&self) -> View {
        View {
            width: self.width,
            height: self.height,
            depth: self.bits,
            centre_x: self.centre_x,
            centre_y: self.centre_y,
            field_of_view: self.field_of_view(),
        }
    }

    fn calibrated(&self, path: &Path) -> anyhow::Result<Optics> {
        let (file, input) = LensFile::read(path)?;
        let scale = self.lens_pitch.map(|pitch| self.scale_from(pitch)).transpose()?;
        if file.size.is_none() && scale.is_none() && (self.width.is_none() || self.height.is_none()) {
            return Err(CallError::LensSizeMissing { path: path.to_owned() }.into());
        }
        Ok(Optics::of_lens_file(input, &file, scale, &self.view(), self.by(Rows::Fitted))?)
    }

    /// How many pixels of the frame correspond to one pixel of a camera with this `pitch`.
    fn scale_from(&self, pitch: f64) -> Result<f64, LensError> {
        let pitches = [pitch, self.pixel_pitch()];
        match pitches.into_iter().find(|pitch| !(pitch.is_finite() && *pitch > 0.0)) {
            Some(wrong) => Err(LensError::PixelPitch(wrong)),
            None => Ok(pitch / self.pixel_pitch()),
        }
    }
}

/// The help of an option that takes a kernel.
pub(crate) fn kernel_help(instead: &str) -> String {
    format!("The kernel: {}, or a file{instead}", kernels::names(", "))
}

/// The tables `named` if given, otherwise those of the lens; `kernel_name` replaces the kernel of the table file.
pub(crate) fn choose(
    named: Option<NamedTables>,
    lens: &LensArguments,
    kernel_name: Option<&OsStr>,
) -> Result<Chosen, Failure> {
    let (input, file) = named.map(|NamedTables { input, file }| (input, file)).unzip();
    let path = input.as_ref().map(|input| input.path.as_path());
    let optics = lens.optics()?;
    if let TablesBy::Exact { .. } = optics.by {
        lens.refuse_field_of_view("a grid")?;
    }
    optics::choose(path.zip(file), optics, kernel_name).map_err(|error| match error {
        OpticsError::Kernel { .. } | OpticsError::File(_) => Failure::from(error).in_value_of("--kernel"),
        error => error.into(),
    })
}
