//! What is kept: copies of it, and what need not be kept for ever.

mod copy;
mod prune;

pub use copy::{Copied, CopyError, backup, restore};
pub use prune::{Pruned, prune};
