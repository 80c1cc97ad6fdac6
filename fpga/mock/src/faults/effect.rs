//! Faults that a run never comes upon, so that who asks for one is told.

use super::BoardFault;

/// What a board is given under one generation of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streamed {
    /// Rows of a frame.
    pub height: usize,
    /// Frames, one behind the other.
    pub frames: usize,
}

impl BoardFault {
    /// Why the fault changes nothing when a board plays the `streamed` frames, and what would; none when it may change
    /// something.
    #[must_use]
    pub fn without_effect(&self, streamed: &Streamed) -> Option<String> {
        let Streamed { height, frames } = *streamed;
        match *self {
            Self::RowFactor { row, .. }
            | Self::LostRow { row }
            | Self::DriftingTable { row, .. }
            | Self::SpoiltRow { row, .. }
            | Self::WarmBit { row, .. }
            | Self::HiddenPause { row }
                if usize::from(row) >= height =>
            {
                let last = height.saturating_sub(1);
                Some(format!("there is no row={row} in frames of {height} rows; give one from 0 to {last}"))
            }
            Self::TapOffset { columns: 0 } => {
                Some("columns=0 leaves the taps where they are; give -3 to -1 or 1 to 3".to_owned())
            }
            Self::DeadTap { tap, reads: Some(other) } if tap == other => Some(format!(
                "tap={tap},reads={other} lets the tap carry its own sample; give another tap, or leave reads out"
            )),
            Self::DriftingTable { after, row, .. } => {
                let last = (frames.saturating_sub(1) * height + usize::from(row)) as u64;
                (u64::from(after) > last).then(|| {
                    format!(
                        "with after={after} the bit flips when row {row} has been played for the last time, behind \
                         {last} others; give {last} at most, or stream more frames"
                    )
                })
            }
            _ => None,
        }
    }
}
