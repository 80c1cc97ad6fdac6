//! What a host sets for a run: the frame's shape and the time between its rows.

use crate::depth::Depth;
use crate::options::Options;

/// Columns of the narrowest row. With narrower ones a third row could be under way.
const LEAST_WIDTH: u16 = 64;

/// Settings that a board does not accept.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SettingsError {
    /// A row is still inside the core.
    #[error("a row is still inside the core; play the frame's last row first")]
    Busy,
    /// The width is odd or out of range.
    #[error(
        "a width of {width} columns is odd or out of range; give an even one from {LEAST_WIDTH} to {most}"
    )]
    Width {
        /// Columns asked for.
        width: u16,
        /// Columns of the widest row.
        most: u16,
    },
    /// The height is out of range.
    #[error("a height of {height} rows is out of range; give 1 to {most}")]
    Height {
        /// Rows asked for.
        height: u16,
        /// Rows of the highest frame.
        most: u16,
    },
    /// The optical centre lies outside the frame.
    #[error("twice the centre's column is {centre2}; give 0 to {most}")]
    Centre {
        /// Twice the centre's column.
        centre2: u16,
        /// Twice the last column.
        most: u16,
    },
    /// The build does not have this depth.
    #[error("samples of {bits} bits are not supported; choose a depth that the board advertises")]
    Depth {
        /// Bits a sample.
        bits: u8,
    },
    /// The build needs more blanking between rows.
    #[error("{blanking} blank pixel clocks between rows are too few; give at least {least}")]
    Blanking {
        /// Pixel clocks asked for.
        blanking: u16,
        /// Pixel clocks that the build needs.
        least: u16,
    },
}

/// The settings of a run. They change only while the core is empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Columns W, even, 64 to the build's maximum.
    pub width: u16,
    /// Rows H, 1 to the build's maximum.
    pub height: u16,
    /// Twice the optical centre's column, C, 0 to 2W − 2.
    pub centre2: u16,
    /// Bits a sample.
    pub depth: Depth,
    /// Pixel clocks without a sample before every row of a frame except its first.
    pub blanking: u16,
    /// Seed of the pattern of gaps; 0 for none.
    pub gap_seed: u32,
}

impl Settings {
    /// The settings of a board that was just switched on: its largest frame, with the centre in the middle.
    #[must_use]
    pub fn at_power_up(options: &Options) -> Self {
        Self {
            width: options.max_width,
            height: options.max_height,
            centre2: options.max_width.saturating_sub(1),
            depth: options.depths.iter().copied().max().unwrap_or(Depth::Twelve),
            blanking: options.least_blanking,
            gap_seed: 0,
        }
    }

    /// Checks whether a build can run with these settings.
    ///
    /// # Errors
    /// The first setting that the build cannot run with.
    pub fn check(&self, options: &Options) -> Result<(), SettingsError> {
        let &Self { width, height, centre2, depth, blanking, .. } = self;
        if !options.depths.contains(&depth) {
            return Err(SettingsError::Depth { bits: depth.bits() });
        }
        if width % 2 != 0 || !(LEAST_WIDTH..=options.max_width).contains(&width) {
            return Err(SettingsError::Width { width, most: options.max_width });
        }
        if !(1..=options.max_height).contains(&height) {
            return Err(SettingsError::Height { height, most: options.max_height });
        }
        let most = (width - 1).saturating_mul(2);
        if centre2 > most {
            return Err(SettingsError::Centre { centre2, most });
        }
        if blanking < options.least_blanking {
            return Err(SettingsError::Blanking { blanking, least: options.least_blanking });
        }
        Ok(())
    }
}
