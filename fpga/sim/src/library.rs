//! A board with faults in it, compiled separately from this program (shim/faulty.h).

use std::path::Path;

use crate::board::Board;
use crate::byte_port::BytePort;
use crate::ffi::FaultyFunctions;

/// A library that holds no faulty board.
#[derive(Debug, thiserror::Error)]
#[error("{path} cannot be used as a board with faults; build it with `scripts/hardware coverage`")]
pub struct LibraryError {
    path: String,
    source: libloading::Error,
}

/// A build of the board that contains many faults, one of which is chosen by its number.
pub struct FaultyBoard(FaultyFunctions);

impl FaultyBoard {
    /// The board in `loaded`, the result of loading `path`.
    pub(crate) fn of(
        loaded: Result<FaultyFunctions, libloading::Error>,
        path: &Path,
    ) -> Result<Self, LibraryError> {
        loaded.map(Self).map_err(|source| LibraryError { path: path.display().to_string(), source })
    }

    /// The board with this fault, 0 for none, switched on and reset. `seed` draws the initial contents of its registers and
    /// memories. A board that is not at rest `patience` clocks after the last byte that it took is given up. Each board keeps
    /// the fault that it was switched on with.
    pub fn switch_on(&mut self, fault: u16, seed: u32, patience: u32) -> Board {
        let functions = self.0.choose(fault);
        Board::with(BytePort::new(functions, seed), patience)
    }
}
