//! Turns the options of a target string into a mock board behind a pipe.

use halfrow_pipe::{Pipe, PipeSetup, TargetError};

use crate::board::Board;
use crate::faults::BoardFault;
use crate::options::{OptionError, Options};

/// Options that describe no mock board, or no pipe to it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConnectError {
    /// An option is unknown or has a wrong value.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Options of the board do not fit each other.
    #[error("the board cannot be built")]
    Build(#[from] OptionError),
}

/// The mock board behind a pipe that the options of a target string describe, as in
/// `mock,fault=flip,rate=1e-4,seed=3,latency=10,speed=1200000,delay=0.001`: those of the board's build ([`Options`]), those of
/// the pipe, and at most one fault of the pipe and one of the board with their parameters ([`halfrow_pipe::FAULTS`],
/// [`crate::FAULTS`]).
///
/// # Errors
/// [`ConnectError`] when a key is unknown, given twice or used by both faults, when a value is out of range, or when the build
/// cannot exist or lacks the part that the fault would break.
pub fn connect(options: &[(&str, &str)]) -> Result<Pipe<Board>, ConnectError> {
    let mut build = Options::default();
    let (setup, fault) = PipeSetup::with_board(options, &mut build)?;
    let board = Board::new(&build, fault)?;
    fault.map_or(Ok(()), |fault| fault.check_part(&build))?;
    Ok(setup.connect(board))
}

/// The board's fault that [`connect`] would build in for these options, if there is one.
///
/// # Errors
/// [`TargetError`] as there. Whether the build can exist is not checked.
pub fn board_fault(options: &[(&str, &str)]) -> Result<Option<BoardFault>, TargetError> {
    PipeSetup::with_board(options, &mut Options::default()).map(|(_, fault)| fault)
}

/// The build that [`connect`] would make for these options.
///
/// # Errors
/// [`TargetError`] as there. Whether the build can exist is not checked.
pub fn board_build(options: &[(&str, &str)]) -> Result<Options, TargetError> {
    let mut build = Options::default();
    PipeSetup::with_board(options, &mut build)?;
    Ok(build)
}
