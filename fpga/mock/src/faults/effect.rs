//! Faults that a run never comes upon, so that who asks for one is told.

use super::BoardFault;

/// What a board is given under one generation of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streamed {
    /// Rows of a frame.
    pub height: usize,
    /// Entries of the grid that its rows are made with; none for row factors.
    pub grid: Option<usize>,
    /// Frames, one behind the other.
    pub frames: usize,
}

impl BoardFault {
    /// Why the fault changes nothing when a board plays the `streamed` frames, and what would; none when it may change
    /// something.
    #[must_use]
    pub fn without_effect(&self, streamed: &Streamed) -> Option<String> {
        match *self {
            Self::RowFactor { row, .. } => streamed.lacks_entry(row),
            Self::DriftingTable { after, row, .. } => {
                streamed.lacks_entry(row).or_else(|| streamed.ends_before(after, row))
            }
            Self::LostRow { row }
            | Self::SpoiltRow { row, .. }
            | Self::WarmBit { row, .. }
            | Self::HiddenPause { row } => streamed.lacks_row(row),
            Self::TapOffset { columns: 0 } => {
                Some("columns=0 leaves the taps where they are; give -3 to -1 or 1 to 3".to_owned())
            }
            Self::DeadTap { tap, reads: Some(other) } if tap == other => Some(format!(
                "tap={tap},reads={other} lets the tap carry its own sample; give another tap, or leave reads out"
            )),
            _ => None,
        }
    }
}

impl Streamed {
    fn lacks_row(&self, row: u16) -> Option<String> {
        let Self { height, .. } = self;
        let last = height.saturating_sub(1);
        (usize::from(row) >= *height)
            .then(|| format!("there is no row={row} in frames of {height} rows; give one from 0 to {last}"))
    }

    /// The same for an entry, which is a row's or a grid's.
    fn lacks_entry(&self, row: u16) -> Option<String> {
        let Some(entries) = self.grid else { return self.lacks_row(row) };
        let last = entries.saturating_sub(1);
        (usize::from(row) >= entries)
            .then(|| format!("there is no entry row={row} in a grid of {entries}; give one from 0 to {last}"))
    }

    /// What flips behind so many rows flips too late. The host reads a grid back when the last row has been played.
    fn ends_before(&self, after: u32, row: u16) -> Option<String> {
        let (row, what) = match self.grid {
            None => (usize::from(row), format!("row {row}")),
            Some(_) => (self.height.saturating_sub(1), "the last row".to_owned()),
        };
        let last = (self.frames.saturating_sub(1) * self.height + row) as u64;
        (u64::from(after) > last).then(|| {
            format!(
                "with after={after} the bit flips when {what} has been played for the last time, behind {last} others; \
                 give {last} at most, or stream more frames"
            )
        })
    }
}
