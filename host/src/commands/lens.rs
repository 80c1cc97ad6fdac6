//! The options of geometry, lens and kernel, which several commands share.

use std::path::Path;

use clap::Args;
use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, Kernel, LensError, Phase, TableSet};

use crate::frames::Scene;
use crate::kernels::NamedKernel;
use crate::tables::{KernelFile, TableFile, TableFileError};

/// The size and depth of frames, the lens, and the optical centre. The defaults are the paper's system.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Frame and lens")]
pub(super) struct LensArguments {
    /// Columns, even, 64 to 2592
    #[arg(long, default_value_t = 1920, value_name = "SAMPLES")]
    width: usize,
    /// Rows, 1 to 2048
    #[arg(long, default_value_t = 1080, value_name = "ROWS")]
    height: usize,
    /// Bits a sample: 8, 10 or 12
    #[arg(long, default_value = "12", value_parser = depth)]
    bits: BitDepth,
    /// Bayer phase: grbg, rggb, bggr or gbrg
    #[arg(long, default_value_t = Phase::Grbg)]
    pub(super) phase: Phase,
    /// Radius of the image of 180 degrees, in pixels, instead of focal length and pixel pitch
    #[arg(long, value_name = "PIXELS", conflicts_with_all = ["focal_length", "pixel_pitch", "field_of_view"])]
    radius: Option<f64>,
    /// Focal length of the lens, in millimetres
    #[arg(long, default_value_t = 1.55, value_name = "MM")]
    focal_length: f64,
    /// Distance between two pixels, in micrometres
    #[arg(long, default_value_t = 2.2, value_name = "UM")]
    pixel_pitch: f64,
    /// Field of view of the whole image circle, in degrees
    #[arg(long, default_value_t = 180.0, value_name = "DEGREES")]
    field_of_view: f64,
    /// Column of the optical centre [default: the middle]
    #[arg(long, value_name = "COLUMN", allow_negative_numbers = true)]
    centre_x: Option<f64>,
    /// Row of the optical centre [default: the middle]
    #[arg(long, value_name = "ROW", allow_negative_numbers = true)]
    pub(super) centre_y: Option<f64>,
}

fn depth(text: &str) -> Result<BitDepth, String> {
    text.parse().ok().and_then(BitDepth::from_bits).ok_or_else(|| "a sample has 8, 10 or 12 bits".to_owned())
}

impl LensArguments {
    pub(super) fn geometry(&self) -> Result<Geometry, halfrow_model::GeometryError> {
        let centred = Geometry::centred(self.width, self.height, self.bits)?;
        self.centre_x.map_or(Ok(centred), |column| centred.with_centre(column))
    }

    pub(super) fn lens(&self) -> Result<Equidistant, LensError> {
        match self.radius {
            Some(radius) => Equidistant::from_radius(radius),
            None => Equidistant::from_focal_length(self.focal_length, self.pixel_pitch, self.field_of_view),
        }
    }

    /// What built-in frames are made for.
    pub(super) fn scene(&self, seed: u64) -> anyhow::Result<Scene> {
        Ok(Scene {
            geometry: self.geometry()?,
            centre_y: self.centre_y,
            phase: self.phase,
            lens: self.lens()?,
            seed,
        })
    }

    /// Row factors by Eq. 9, with a sentence on where they come from.
    pub(super) fn tables(&self) -> anyhow::Result<(TableSet, String)> {
        let (geometry, lens) = (self.geometry()?, self.lens()?);
        let tables = TableSet::from_lens(geometry, &lens, self.centre_y)?;
        let source = format!("equidistant lens, R = {:.3} pixels (Eq. 9)", lens.radius());
        Ok((tables, source))
    }
}

/// A kernel by name, or from a kernel file.
pub(super) fn kernel(name: &str) -> Result<Kernel, super::Failure> {
    match name.parse::<NamedKernel>() {
        Ok(named) => named.kernel().map_err(super::Failure::error),
        Err(unknown) if !Path::new(name).exists() => {
            Err(anyhow::anyhow!("there is no file {name}, and {unknown}, or a kernel file").into())
        }
        Err(_) => Ok(KernelFile::read(Path::new(name)).map_err(table_failure)?.kernel),
    }
}

/// Tables, kernel, and where they come from: a table file, or the lens options and a kernel.
pub(super) struct Chosen {
    pub(super) tables: TableSet,
    pub(super) kernel: Kernel,
    pub(super) source: String,
}

/// Takes the table file if there is one, and the lens otherwise; `kernel_name` replaces the file's kernel.
pub(super) fn choose(
    file: Option<&Path>,
    lens: &LensArguments,
    kernel_name: Option<&str>,
) -> Result<Chosen, super::Failure> {
    let named = kernel_name.map(kernel).transpose()?;
    let Some(path) = file else {
        let (tables, from) = lens.tables()?;
        let name = kernel_name.unwrap_or(Interpolant::Hermite.name());
        let kernel = named.unwrap_or_else(|| Kernel::from(Interpolant::Hermite));
        return Ok(Chosen { tables, kernel, source: format!("{from}, {name} kernel") });
    };
    let read = TableFile::read(path).map_err(table_failure)?;
    let mut source = path.display().to_string();
    if let Some(name) = kernel_name {
        source = format!("{source}, {name} kernel");
    }
    Ok(Chosen { tables: read.tables, kernel: named.unwrap_or(read.kernel), source })
}

/// A table file of another datapath is refused like a board of another datapath.
pub(super) fn table_failure(error: TableFileError) -> super::Failure {
    let exit = match error {
        TableFileError::Datapath { .. } => crate::verdict::Exit::Refused,
        _ => crate::verdict::Exit::Usage,
    };
    super::Failure { exit, error: error.into() }
}
