//! Faults that a run never reaches or a build cannot have, so that whoever asks for one can be told.

use super::{BoardFault, Conduct};
use crate::core::Weight;
use crate::options::{BurstBuild, OptionError, Options, TapCount};

/// What a board is given with one generation of tables, and what it makes besides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Streamed {
    /// Samples of a row.
    pub width: usize,
    /// Rows of a frame.
    pub height: usize,
    /// Entries of the grid that its rows are made with; none for row factors.
    pub grid: Option<usize>,
    /// Frames, some of them after a CONFIGURE of their own.
    pub frames: usize,
    /// Whether the board then makes frames of its own, to be judged at speed.
    pub at_speed: bool,
    /// Rows of the frames that are then streamed for the wire's rules, and of those among them that are as wide as the board
    /// takes; none if the rules are not tried.
    pub of_rules: Option<(usize, usize)>,
    /// Rows of the tallest frame that the board makes of its own, at speed or for the rules; none if it makes none.
    pub made: Option<usize>,
    /// W and C of all rows that are played, wherever they come from.
    pub centres: Vec<(usize, u32)>,
    /// The most bits of their depths.
    pub bits: u32,
    /// Whether the pipe to the board has a fault as well.
    pub is_harmed: bool,
}

impl BoardFault {
    /// Why the fault changes nothing when a board of this `build` plays the frames of `streamed`, and what would make it take
    /// effect; none when it may change something, or when the build lacks the part that the fault breaks.
    #[must_use]
    pub fn without_effect(&self, streamed: &Streamed, build: &Options) -> Option<String> {
        match *self {
            // Such a board is refused with the option that takes the part away.
            _ if self.check_part(build).is_err() => None,
            // The rules have entries of every row written and read.
            Self::RowFactor { row, hidden: false, .. }
                if streamed.of_rules.is_some() && row < build.max_height =>
            {
                None
            }
            Self::RowFactor { row, .. } => streamed.lacks_entry(row),
            Self::DriftingTable { after, row, .. } => {
                streamed.lacks_entry(row).or_else(|| streamed.ends_before(after, row))
            }
            Self::LostRow { row } => streamed.lacks_row(row),
            Self::SpoiltRow { row, column, .. } => streamed.lacks_sample(row, column),
            Self::WarmBit { row, .. } | Self::HiddenPause { row } => {
                let rows = streamed.made.unwrap_or(0);
                Streamed::lacks_speed(streamed.made.is_some()).or_else(|| lacks(row, rows))
            }
            Self::SlowPath { .. } => Streamed::lacks_speed(streamed.made.is_some()),
            Self::LateSwap | Self::WrongClockClaim => Streamed::lacks_speed(streamed.at_speed),
            Self::UncheckedCommit => streamed.lacks_rules(),
            // Any run tests the link, and goes on after a RESET.
            Self::Conduct(Conduct::ZeroUnsent | Conduct::ZeroUnread | Conduct::PacketsAnew) => None,
            // Rows and packets that come again, and sessions after the first, may show misconduct.
            Self::Conduct(_) if streamed.is_harmed => None,
            Self::Conduct(_) => streamed.lacks_rules(),
            // The rules have samples of 12 bits played at every depth.
            Self::StuckData { bit, value: false } if streamed.of_rules.is_none() => {
                streamed.lacks_sample_bit(bit)
            }
            Self::CentreIgnored => streamed.lacks_other_centre(),
            Self::StuckCentre { bit, value } => {
                let lacks_bit = lacks_centre_bit(bit, build.max_width).filter(|_| !value);
                lacks_bit.or_else(|| streamed.lacks_centre_bit_other_than(bit, value))
            }
            Self::TapOffset { columns: 0 } => {
                Some("columns=0 leaves the taps where they are; give -3 to -1 or 1 to 3".to_owned())
            }
            Self::DeadTap { tap, reads: Some(other) } if tap == other => Some(format!(
                "tap={tap},reads={other} lets the tap carry its own sample; give another tap, or leave reads out"
            )),
            _ => None,
        }
    }

    /// Checks that a build has the part that the fault breaks.
    pub(crate) fn check_part(&self, build: &Options) -> Result<(), OptionError> {
        let lines = build.ring_size().ilog2();
        match *self {
            Self::StuckAddress { bit, .. } if u32::from(bit) >= lines => {
                Err(OptionError::NoAddressLine { bit, last: lines.saturating_sub(1) })
            }
            Self::DeadTap { tap: tap @ (0 | 6), .. } if build.taps == TapCount::Five => {
                Err(OptionError::NoTap { key: "tap", tap })
            }
            Self::DeadTap { reads: Some(tap @ (0 | 6)), .. } if build.taps == TapCount::Five => {
                Err(OptionError::NoTap { key: "reads", tap })
            }
            Self::KernelWord { weight: weight @ (Weight::G0 | Weight::G6), .. }
                if build.taps == TapCount::Five =>
            {
                Err(OptionError::NoWeight { weight: weight.name() })
            }
            Self::WrongLatencyClaim => build.check_longer_latency(),
            Self::StaleTable { .. } | Self::LateSwap if build.table_banks == 1 => {
                Err(OptionError::NoOtherBank)
            }
            Self::SlowPath { .. }
            | Self::WarmBit { .. }
            | Self::LateSwap
            | Self::HiddenPause { .. }
            | Self::WrongClockClaim
                if build.bursts == BurstBuild::None =>
            {
                Err(OptionError::NoBursts)
            }
            _ => Ok(()),
        }
    }
}

fn lacks(row: u16, height: usize) -> Option<String> {
    let last = height.saturating_sub(1);
    (usize::from(row) >= height)
        .then(|| format!("there is no row={row} in frames of {height} rows; give one from 0 to {last}"))
}

/// A centre is at most in the last column of the widest row.
fn lacks_centre_bit(bit: u8, max_width: u16) -> Option<String> {
    let most = (2 * u32::from(max_width)).saturating_sub(2);
    let last = most.checked_ilog2().unwrap_or(0);
    (u32::from(bit) > last).then(|| {
        format!(
            "twice the centre's column is at most {most}, which has no bit={bit}; give one from 0 to {last}, or value=1"
        )
    })
}

impl Streamed {
    /// Frames that the board makes of its own may be taller than those that it is given.
    fn lacks_row(&self, row: u16) -> Option<String> {
        lacks(row, self.tallest())
    }

    fn tallest(&self) -> usize {
        self.height.max(self.made.unwrap_or(0))
    }

    /// Frames for the rules, which are narrower or as wide as the board takes, may have a sample that streamed ones lack.
    fn lacks_sample(&self, row: u16, column: Option<u16>) -> Option<String> {
        let (small, wide) = self.of_rules.unwrap_or_default();
        let beyond = |rows| usize::from(row) >= rows;
        let lacks_row = || lacks(row, self.height).filter(|_| beyond(small));
        let lacks_column = || self.lacks_column(column?).filter(|_| beyond(wide));
        lacks_row().or_else(lacks_column)
    }

    fn lacks_column(&self, column: u16) -> Option<String> {
        let Self { width, .. } = self;
        let last = width.saturating_sub(1);
        (usize::from(column) >= *width).then(|| {
            format!("there is no column={column} in rows of {width} samples; give one from 0 to {last}")
        })
    }

    fn lacks_speed(has_some: bool) -> Option<String> {
        (!has_some).then(|| {
            "it strikes in frames that the board makes at full speed, and there are none; ask for some"
                .to_owned()
        })
    }

    fn lacks_rules(&self) -> Option<String> {
        self.of_rules.is_none().then(|| {
            "it strikes where the rules of the wire are tried, and this run tries none; give it to `halfrow verify`, \
             which tries them"
                .to_owned()
        })
    }

    fn lacks_sample_bit(&self, bit: u8) -> Option<String> {
        let last = self.bits.saturating_sub(1);
        (u32::from(bit) > last)
            .then(|| format!("no sample that is played has bit={bit}; give one from 0 to {last}, or value=1"))
    }

    fn lacks_other_centre(&self) -> Option<String> {
        let is_middle = |&(width, centre2): &(usize, u32)| centre2 as usize + 1 == width;
        self.centres.iter().all(is_middle).then(|| {
            "every row is played with its centre in the middle; give another centre, or another fault"
                .to_owned()
        })
    }

    fn lacks_centre_bit_other_than(&self, bit: u8, value: bool) -> Option<String> {
        let has_it = |&(_, centre2): &(usize, u32)| (centre2 >> bit & 1 == 1) == value;
        self.centres.iter().all(has_it).then(|| {
            let (level, other) = (u8::from(value), u8::from(!value));
            format!(
                "twice the centre's column is {level} in bit={bit} for every row that is played; give value={other}, or \
                 another centre"
            )
        })
    }

    /// An entry belongs to a row or to a grid.
    fn lacks_entry(&self, row: u16) -> Option<String> {
        let Some(entries) = self.grid else { return self.lacks_row(row) };
        let last = entries.saturating_sub(1);
        (usize::from(row) >= entries.max(self.tallest()))
            .then(|| format!("there is no entry row={row} in a grid of {entries}; give one from 0 to {last}"))
    }

    /// A bit that flips only after more rows than are played flips too late. The host reads a grid back once the last row has
    /// been played.
    fn ends_before(&self, after: u32, row: u16) -> Option<String> {
        let (row, what) = match self.grid {
            None => (usize::from(row), format!("row {row}")),
            Some(_) => (self.height.saturating_sub(1), "the last row".to_owned()),
        };
        let last = (self.frames.saturating_sub(1) * self.height + row) as u64;
        (u64::from(after) > last).then(|| {
            format!(
                "with after={after} the bit flips when {what} has been played for the last time, after {last} \
                 others; give {last} at most, or stream more frames"
            )
        })
    }
}
