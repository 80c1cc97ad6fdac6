//! What is kept: copies of it, and the removal of what need not be kept for ever.

mod copy;
mod prune;
mod unnamed;

pub use copy::{Copied, CopyError, backup, faults, restore};
pub use prune::{Pruned, prune};
pub(crate) use unnamed::{Spool, spools};
pub use unnamed::{Unnamed, prune_unnamed};
