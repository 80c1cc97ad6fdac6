//! Whether a board can take what a plan uploads.

use halfrow_model::{BitDepth, CorrectError, GridShape, Kernel, TableError, TableSet, Taps};
use halfrow_protocol::message::{BoardNature, UnknownDatapath};

use super::within::WithinError;
use super::{FrameSource, Plan, PlanLengthError};
use crate::board::{Capabilities, grids};

/// Why a board cannot have tables, a kernel or frames: the call does not fit the board, or the board not this program, so
/// that there is nothing to judge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Misfit {
    /// The board has a datapath that this program cannot make tables for.
    #[error("no tables can be made for this board's datapath")]
    Datapath(#[from] UnknownDatapath),
    /// The frames are larger than the board takes.
    #[error(
        "frames of {width} x {height} do not fit the board, which takes {most_width} x {most_height} at most; {remedy}"
    )]
    Size {
        /// Columns of the frames.
        width: usize,
        /// Rows.
        height: usize,
        /// The board's most columns.
        most_width: usize,
        /// And rows.
        most_height: usize,
        /// What to do.
        remedy: String,
    },
    /// The board does not take samples of the tables' depth.
    #[error(
        "the board has no {bits}-bit samples, only those of {} bits; name the bits of one of these, or use tables of such a \
         depth",
        .taken.iter().map(u32::to_string).collect::<Vec<_>>().join(" or ")
    )]
    Depth {
        /// Bits a sample.
        bits: u32,
        /// Those that the board takes.
        taken: Vec<u32>,
    },
    /// The tables are a grid, but the board takes only one factor per row.
    #[error(
        "the tables are a grid of datapath 2, and the board has datapath 1 alone; leave out the exact projection, or use a \
         bitstream with datapath 2"
    )]
    NoGrids,
    /// The grid has more entries than a bank of the board.
    #[error(
        "the grid has {entries} entries, and the board has room for {most}; limit the entries of a grid to {most}"
    )]
    GridEntries {
        /// Entries of the grid.
        entries: usize,
        /// T.
        most: usize,
    },
    /// The grid's nodes are at another distance than the board takes.
    #[error(
        "the grid has a node every {pitch} columns, which the board does not take; set the nodes of a grid to one every {taken}"
    )]
    GridPitch {
        /// 2^k.
        pitch: usize,
        /// The least that the board takes.
        taken: usize,
    },
    /// The kernel needs more taps than the board has.
    #[error("the kernel needs seven taps and the board has five; use a five-tap kernel such as hermite")]
    Taps,
    /// A row reads ahead of what the board's line memory holds.
    #[error(transparent)]
    Ring(#[from] TableError),
    /// A frame that was given has another size or depth than the tables are for.
    #[error("the frame {name} does not fit the tables")]
    Frame {
        /// Its name in reports.
        name: String,
        /// In what.
        source: CorrectError,
    },
    /// The optical centre of built-in frames is at no row.
    #[error(
        "the optical centre of built-in frames is at row {0}; give a finite number, or none for the middle of the frame"
    )]
    CentreRow(f64),
    /// No frame, or more than any run can have.
    #[error(transparent)]
    Length(#[from] PlanLengthError),
    /// The time that there is does not suffice.
    #[error(transparent)]
    Within(#[from] WithinError),
}

impl Misfit {
    /// Whether the board does not fit this program, rather than the call the board.
    #[must_use]
    pub fn is_other_datapath(&self) -> bool {
        matches!(self, Self::Datapath(_))
    }
}

/// Checks whatever of `plan` no board is needed for: that it has frames, that these can be numbered and made, and that its tables
/// fit those that it was given.
///
/// # Errors
/// [`Misfit::Length`], [`Misfit::CentreRow`], or [`Misfit::Frame`] for the first frame that the tables do not fit.
pub(crate) fn check_frames(plan: &Plan) -> Result<(), Misfit> {
    plan.check_length()?;
    if let Some(row) = plan.centre_y.filter(|row| !row.is_finite()) {
        return Err(Misfit::CentreRow(row));
    }
    plan.frames.iter().try_for_each(|own| match own {
        FrameSource::Builtin(_) => Ok(()),
        FrameSource::File { frame, .. } => {
            plan.tables.check_frame(frame).map_err(|source| Misfit::Frame { name: own.name(), source })
        }
    })
}

/// Checks that a board with these capabilities can take the tables and the kernel.
///
/// # Errors
/// [`Misfit`] when it cannot.
pub fn check_fit(tables: &TableSet, kernel: &Kernel, capabilities: &Capabilities) -> Result<(), Misfit> {
    capabilities.known_datapath()?;
    let geometry = tables.geometry();
    let (width, height) = (geometry.width(), geometry.height());
    let (most_width, most_height) = (capabilities.max_width.into(), capabilities.max_height.into());
    if width > most_width || height > most_height {
        let mut remedy = "use smaller frames and tables".to_owned();
        if capabilities.nature == BoardNature::Mock {
            remedy = format!("{remedy}, or the built-in mock with room for these: mock,max-width={width}");
            if height > most_height {
                remedy = format!("{remedy},max-height={height}");
            }
        }
        return Err(Misfit::Size { width, height, most_width, most_height, remedy });
    }
    let (bits, depths) = (geometry.depth().bits(), capabilities.sample_depths());
    if !depths.has(bits as u8) {
        let taken = BitDepth::ALL.map(BitDepth::bits).into_iter().filter(|&bits| depths.has(bits as u8));
        return Err(Misfit::Depth { bits, taken: taken.collect() });
    }
    check_grid(tables, capabilities)?;
    if kernel.taps() == Taps::Seven && capabilities.taps < 7 {
        return Err(Misfit::Taps);
    }
    Ok(tables.check_ring(usize::from(capabilities.ring))?)
}

/// Checks that a board can take the grid, if the tables are one.
fn check_grid(tables: &TableSet, capabilities: &Capabilities) -> Result<(), Misfit> {
    let Some(shape) = tables.shape() else { return Ok(()) };
    let grids = grids(capabilities).ok_or(Misfit::NoGrids)?;
    let (entries, most) = (tables.entries().len(), usize::from(grids.entries));
    if entries > most {
        return Err(Misfit::GridEntries { entries, most });
    }
    match GridShape::K.into_iter().find(|&k| grids.takes(k as u8)) {
        Some(k) if !grids.takes(shape.k() as u8) => {
            Err(Misfit::GridPitch { pitch: shape.column_pitch(), taken: 1 << k })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{Camera, Equidistant, Geometry, Interpolant};

    use super::*;
    use crate::run::plan::prices::usual_capabilities;

    /// Bit k of capability 12 is 1 for every k that the board takes.
    #[test]
    fn a_grid_of_another_k_is_refused_with_the_distance_of_nodes_that_the_board_takes() {
        let geometry = Geometry::centred(64, 8, BitDepth::Twelve).unwrap();
        let camera = Camera::new(geometry, Equidistant::default().into(), (31.5, 3.5), 180.0).unwrap();
        let kernel = Kernel::from(Interpolant::Hermite);
        for (k, ks, columns) in [(5, 0x40, Some(64)), (6, 0x20, Some(32)), (6, 0x60, None), (5, 0xa0, None)] {
            let tables = camera.grid_by_formula(GridShape::new(2, k).unwrap());
            let plan = Plan::new(tables.clone(), kernel.clone());
            let mut board = usual_capabilities(&plan, BoardNature::Hardware);
            board.grids.iter_mut().for_each(|grids| grids.ks = ks);
            let said = check_fit(&tables, &kernel, &board).err().map(|misfit| misfit.to_string());
            let remedy = columns.map(|columns| format!("set the nodes of a grid to one every {columns}"));
            let is_right = match (&said, &remedy) {
                (Some(said), Some(remedy)) => said.ends_with(remedy),
                (said, remedy) => said.is_none() && remedy.is_none(),
            };
            assert!(is_right, "k = {k} of {ks:#x}: {said:?}");
        }
    }
}
