//! Tables and kernel that belong together.

use halfrow_model::{Kernel, TableSet};

/// Tables and kernel that are committed as one generation.
#[derive(Clone, Debug)]
pub struct Generation {
    /// The generation's number, 1 to 255.
    pub number: u8,
    /// Row factors or a grid.
    pub tables: TableSet,
    /// The kernel.
    pub kernel: Kernel,
}

impl Generation {
    /// The same generation for frames of only the first `rows` rows.
    pub(crate) fn upper(&self, rows: usize) -> Option<Self> {
        let Self { number, tables, kernel } = self;
        Some(Self { number: *number, tables: tables.upper(rows)?, kernel: kernel.clone() })
    }
}
