//! What can keep an item from being made.

use std::io;
use std::path::PathBuf;

use halfrow_model::{
    CameraError, CorrectError, FrameError, GeometryError, GridRoomError, LensError, TableError,
};

use halfrow::board::BoardError;
use halfrow::correction::CorrectionError;
use halfrow::run::Misfit;

/// An item that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// The board failed during an experiment of the paper.
    #[error("the board could not be tried")]
    Board(#[from] BoardError),
    /// The board cannot take the item's frames or kernels; the sentence says why and what to do.
    #[error(transparent)]
    Misfit(#[from] Misfit),
    /// An experiment of the paper needs a board and was given none.
    #[error("no board was opened for this item; this is a fault of halfrow, so report it")]
    NoBoard,
    /// The synthesis report cannot be read.
    #[error(
        "{} is no synthesis report that can be used; make it anew with `scripts/hardware resources`",
        path.display()
    )]
    Synthesis {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A frame for an experiment of the paper could not be made.
    #[error("a frame of the experiment cannot be made; this is a fault of halfrow, so report it")]
    Frame(#[from] FrameError),
    /// A frame for an experiment of the paper could not be corrected.
    #[error("a frame of the experiment cannot be corrected; this is a fault of halfrow, so report it")]
    Correct(#[from] CorrectError),
    /// The size of the paper's frames was refused.
    #[error("the paper's frame is refused; this is a fault of halfrow, so report it")]
    Geometry(#[from] GeometryError),
    /// The paper's lens was refused.
    #[error("the paper's lens is refused; this is a fault of halfrow, so report it")]
    Lens(#[from] LensError),
    /// A lens of the paper's comparison does not fit its frame.
    #[error("a lens of the comparison is refused; this is a fault of halfrow, so report it")]
    Camera(#[from] CameraError),
    /// A grid of the paper's comparison has no room.
    #[error("a grid of the comparison is refused; this is a fault of halfrow, so report it")]
    Room(#[from] GridRoomError),
    /// No projection could be made from the lines that were marked.
    #[error("no projection keeps these lines; check that none of them is given twice, in two ways")]
    Lines,
    /// The paper's row factors were refused.
    #[error("the paper's row factors are refused; this is a fault of halfrow, so report it")]
    Tables(#[from] TableError),
}

impl From<CorrectionError> for PaperError {
    fn from(error: CorrectionError) -> Self {
        match error {
            CorrectionError::Misfit(misfit) => misfit.into(),
            CorrectionError::Frame(unfit) => unfit.into(),
            CorrectionError::Board(error) => error.into(),
        }
    }
}
