//! Tables on disk: row factors or a grid, and the kernel, as JSON, for people and programs, and as memory images for Verilog ([`mem`]).
//!
//! ```json
//! {"datapath": 1, "about": {}, "width": 1920, "height": 1080, "bits": 12, "centre2": 1919,
//!  "step": [row factor Q, one a row], "kernel": [[g0, r1, g4, r5, g6], 65 nodes]}
//! ```
//!
//! Or, with one factor a row replaced by a grid:
//!
//! ```json
//! {"datapath": 2, …, "v": 5, "k": 6, "grid": [entries, column by column], "kernel": […]}
//! ```
//!
//! The numbers are those of DATAPATH.md. Nothing else is in a file but `about`, an object that is kept as it is and never
//! interpreted. A kernel file has `kernel` alone, with `datapath` and `about` if one likes. Every value is checked before
//! it is used, so that a slip of the pen does not look like a broken board.

mod error;
pub mod json;
mod layout;
pub mod mem;
mod members;
mod place;
pub mod text;

pub use error::{ContentError, MemError, TableFileError, WrongDatapath};
pub use json::{KernelFile, TableFile};
pub use place::Place;

use halfrow_model::TableSet;
use halfrow_protocol::message::Datapath;

/// The datapath that every board has, and that a kernel by itself is said to be for.
pub const DATAPATH: Datapath = Datapath::RowFactors;

/// The datapath that `tables` are for.
#[must_use]
pub fn datapath_of(tables: &TableSet) -> Datapath {
    if tables.shape().is_some() { Datapath::Grids } else { Datapath::RowFactors }
}
