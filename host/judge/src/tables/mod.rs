//! Tables on disk: row factors or a grid, and the kernel; as JSON for people and programs, and as memory images for Verilog
//! ([`mem`]).
//!
//! ```json
//! {"datapath": 1, "about": {}, "width": 1920, "height": 1080, "bits": 12, "centre2": 1919,
//!  "step": [row factor Q, one a row], "kernel": [[g0, r1, g4, r5, g6], 65 nodes]}
//! ```
//!
//! With a grid in place of one factor a row:
//!
//! ```json
//! {"datapath": 2, …, "v": 5, "k": 6, "grid": [entries, column by column], "kernel": […]}
//! ```
//!
//! The numbers are those of DATAPATH.md. The only other key is `about`, an object that is kept, its numbers as doubles, and never
//! interpreted. A kernel file has `kernel`; `datapath` and `about` are optional there. Every value is checked before it is
//! used, so that a typing error does not look like a broken board.

mod error;
mod format;
mod generation;
pub mod json;
mod layout;
pub mod mem;
mod members;
mod place;

pub use error::{ContentError, MemError, TableFileError, WrongDatapath};
pub use format::{TableFormat, UnknownTableFormat};
pub use generation::Generation;
pub use json::{KernelFile, TableFile};
pub use place::Place;

use halfrow_model::TableSet;
use halfrow_protocol::message::Datapath;

/// The datapath that every board has. Kernels, which are the same for all datapaths, are written as being for this one.
pub const DATAPATH: Datapath = Datapath::RowFactors;

/// The datapath that `tables` are for.
#[must_use]
pub fn datapath_of(tables: &TableSet) -> Datapath {
    if tables.shape().is_some() { Datapath::Grids } else { Datapath::RowFactors }
}
