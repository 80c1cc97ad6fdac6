//! From the options of a target string to a mock board behind a pipe.

use halfrow_pipe::{Pipe, PipeSetup, TargetError};

use crate::board::Board;
use crate::faults::BoardFault;
use crate::options::{OptionError, Options};

/// Options that make no mock board, or no pipe to it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConnectError {
    /// An option is unknown or has a wrong value.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Options of the board do not fit each other.
    #[error("the board cannot be built like this; correct its options or leave them out")]
    Build(#[from] OptionError),
}

/// The mock board behind a pipe that the options of a target string describe, as in
/// `mock,fault=flip,rate=1e-4,seed=3,latency=10,speed=1200000,delay=0.001`: those of the board's build ([`Options`]), those of
/// the pipe, and at most one fault of the pipe and one of the board with their parameters ([`halfrow_pipe::FAULTS`],
/// [`crate::FAULTS`]).
///
/// # Errors
/// [`ConnectError`] when a key is unknown, given twice or taken by both faults, a value is out of range, or the build cannot
/// exist or has not got the part that the fault is of.
pub fn connect(options: &[(&str, &str)]) -> Result<Pipe<Board>, ConnectError> {
    let mut build = Options::default();
    let (setup, fault) = PipeSetup::with_board(options, &mut build)?;
    let board = Board::new(&build, fault)?;
    fault.map_or(Ok(()), |fault| fault.check_part(&build))?;
    Ok(setup.connect(board))
}

/// The fault of the board that [`connect`] would build from the same options, if it has one.
///
/// # Errors
/// [`TargetError`] as there, but for a build that cannot exist.
pub fn board_fault(options: &[(&str, &str)]) -> Result<Option<BoardFault>, TargetError> {
    PipeSetup::with_board(options, &mut Options::default()).map(|(_, fault)| fault)
}
