//! Plays rows through the core as a sensor would, and measures how long they take.

use std::borrow::Cow;

use crate::banks::{OutBanks, RowName};
use crate::core::{Core, Entering, Leaving, RowBinding, StuckBits};
use crate::faults::{BoardFault, Conduct, Defects};
use crate::gaps::Gaps;
use crate::options::{OptionError, Options};
use crate::settings::{Settings, SettingsError};
use crate::tables::Tables;

/// A row to be played.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowIn {
    /// The row sequence number, passed on to the row's output.
    pub sequence: u32,
    /// The frame's number.
    pub frame: u16,
    /// The row in its frame, from 0.
    pub row: u16,
    /// Whether it is the last of its frame, so that the core is flushed after it.
    pub last: bool,
    /// Its samples, W of them.
    pub samples: Vec<u16>,
}

/// A row that the player refuses.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlayError {
    /// All out-banks are in use.
    #[error("no out-bank is free; fetch a corrected row first")]
    NoBank,
    /// The row does not have the width that was set.
    #[error("the row has {samples} samples where {width} are set; send rows of the width that was set")]
    Width {
        /// Samples of the row.
        samples: usize,
        /// Columns that were set.
        width: u16,
    },
    /// The row is not in the frame that was set.
    #[error("row {row} is not in a frame of {height} rows; send rows below {height}")]
    Row {
        /// The row's number.
        row: u16,
        /// Rows that were set.
        height: u16,
    },
}

/// What is wrong with a player; nothing by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlayerDefects {
    /// The row of every frame that goes in and never comes out.
    pub(crate) lost_row: Option<u16>,
    /// A bit that flips between the in-bank and the core.
    pub(crate) spoilt: Option<SpoiltSample>,
    /// The way of the optical centre's setting into the core.
    pub(crate) centre: CentreDefect,
}

/// What the core gets of the optical centre that is set.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum CentreDefect {
    /// All of it.
    #[default]
    None,
    /// Nothing: it has the middle of the row in its place.
    Ignored,
    /// All but the bits that are stuck.
    Stuck(StuckBits),
}

impl CentreDefect {
    /// One bit of it is stuck.
    pub(crate) fn stuck(bit: u8, value: bool) -> Self {
        Self::Stuck(StuckBits::one(bit, value))
    }
}

/// A sample of every frame that has one bit flipped between the in-bank and the core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpoiltSample {
    /// Its row.
    pub(crate) row: u16,
    /// Its column; none for the middle one.
    pub(crate) column: Option<u16>,
    /// The bit.
    pub(crate) bit: u8,
}

impl SpoiltSample {
    /// Turns a row into what the core gets.
    fn spoil(self, row: u16, samples: &mut [u16]) {
        if row == self.row
            && let Some(sample) = samples.get_mut(self.column.map_or(samples.len() / 2, usize::from))
        {
            *sample ^= 1_u16.checked_shl(self.bit.into()).unwrap_or(0);
        }
    }
}

/// Plays rows through the core, one sample a pixel clock.
///
/// Between rows it stops the pixel enable, so that waiting for the next row adds no pixel clock. The output of a row is
/// complete when half of the next one has entered, or when the core was flushed after the last row of a frame.
#[derive(Debug)]
pub struct Player {
    core: Core,
    options: Options,
    settings: Settings,
    gaps: Gaps,
    pixel_clock: u64,
    /// Pixel clocks without a sample that bring the rest of a frame's last row out.
    flush: u32,
    spoilt: Option<SpoiltSample>,
    centre: CentreDefect,
    /// The gaps of a frame wrongly go on with those of the frame before.
    gaps_go_on: bool,
    /// Where corrected rows wait to be fetched.
    pub banks: OutBanks,
}

impl Player {
    /// A player with an empty core and the settings of power-up.
    ///
    /// # Errors
    /// If the options do not describe a build that can exist.
    pub fn new(options: &Options, fault: Option<BoardFault>) -> Result<Self, OptionError> {
        let defects = Defects::of(fault).player;
        Ok(Self {
            core: Core::new(options, fault)?,
            options: options.clone(),
            settings: Settings::at_power_up(options),
            gaps: Gaps::default(),
            pixel_clock: 0,
            flush: 0,
            spoilt: defects.spoilt,
            centre: defects.centre,
            gaps_go_on: fault == Some(BoardFault::Conduct(Conduct::GapsGoOn)),
            banks: OutBanks::new(options.row_banks_out, defects.lost_row),
        })
    }

    /// The current settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// C as the core gets it: twice the column of the optical centre.
    pub(crate) fn centre2(&self) -> u16 {
        let Settings { width, centre2, .. } = self.settings;
        match self.centre {
            CentreDefect::None => centre2,
            CentreDefect::Ignored => width - 1,
            CentreDefect::Stuck(bits) => bits.apply(centre2),
        }
    }

    /// Changes the settings.
    ///
    /// # Errors
    /// If a row is inside the core, or the build cannot run with the settings.
    pub fn configure(&mut self, settings: Settings) -> Result<(), SettingsError> {
        if !self.banks.is_idle() {
            return Err(SettingsError::Busy);
        }
        settings.check(&self.options)?;
        self.settings = settings;
        self.gaps = Gaps::default();
        Ok(())
    }

    /// Plays a row: the blanking before it, then its samples with the gaps between them. Row 0 starts a frame: the pattern of
    /// gaps restarts, and a commit for this frame takes effect. If the last row of the previous frame has not left completely,
    /// its rest leaves meanwhile.
    ///
    /// # Errors
    /// If no out-bank is free or the row does not fit the settings. In that case nothing is played.
    pub fn play(&mut self, row: &RowIn, tables: &mut Tables) -> Result<(), PlayError> {
        self.check(row)?;
        let mut blanking = u32::from(self.settings.blanking);
        if row.row == 0 {
            if !self.gaps_go_on || !self.gaps.have_begun() {
                self.gaps.start(self.settings.gap_seed);
            }
            tables.start_frame(row.frame);
        } else {
            blanking += self.gaps.extra_blanking();
        }
        if !self.banks.is_idle() {
            self.blank(blanking);
        }
        self.enter(row, tables);
        self.flush = if row.last { self.core.delay(self.settings.width) } else { 0 };
        Ok(())
    }

    /// Brings out the rest of a frame's last row, if that was the row played last.
    pub fn flush(&mut self) {
        self.blank(self.flush);
        self.flush = 0;
    }

    /// Pixel clocks D between a sample and its output with the current settings, with the core's real latency.
    pub(crate) fn delay(&self) -> u32 {
        self.core.delay(self.settings.width)
    }

    /// The number of the next pixel clock.
    pub(crate) fn now(&self) -> u64 {
        self.pixel_clock
    }

    /// One pixel clock of a burst, whose outputs go to no bank: the output, if any, and the clock's number.
    #[inline(always)]
    pub(crate) fn clock(&mut self, input: Option<Entering<'_>>) -> (Option<Leaving>, u64) {
        let now = self.pixel_clock;
        self.pixel_clock += 1;
        (self.core.clock(input), now)
    }

    fn check(&self, row: &RowIn) -> Result<(), PlayError> {
        let &Settings { width, height, .. } = &self.settings;
        if row.samples.len() != usize::from(width) {
            return Err(PlayError::Width { samples: row.samples.len(), width });
        }
        if row.row >= height {
            return Err(PlayError::Row { row: row.row, height });
        }
        if self.banks.has_room() { Ok(()) } else { Err(PlayError::NoBank) }
    }

    /// Feeds the samples of a row to the core, bound to the current contents of the tables.
    fn enter(&mut self, row: &RowIn, tables: &mut Tables) {
        let bound = tables.bind(row.row, &self.settings);
        let &RowIn { sequence, frame, row: number, .. } = row;
        let name = RowName { sequence, frame, row: number, generation: bound.generation };
        let &Settings { width, depth, .. } = &self.settings;
        let centre2 = self.centre2();
        let binding = RowBinding { width, centre2, depth, values: bound.values, kernel: bound.kernel };
        let mut begins = Some(&binding);
        let mut pauses = 0_u16;
        let mut samples = Cow::Borrowed(&row.samples);
        if let Some(spoilt) = self.spoilt {
            spoilt.spoil(number, samples.to_mut());
        }
        self.banks.open(name, samples.len(), self.pixel_clock);
        for &sample in samples.iter() {
            pauses = pauses.saturating_add(self.gaps.pauses().into());
            self.tick(Some(Entering { sample, begins: begins.take() }));
        }
        let bytes: Vec<_> = samples.iter().map(|sample| sample.to_le_bytes()).collect();
        self.banks.entered(crc32fast::hash(bytes.as_flattened()), pauses, self.pixel_clock - 1);
    }

    /// Lets pixel clocks pass without a sample.
    fn blank(&mut self, clocks: u32) {
        for _ in 0..clocks {
            self.tick(None);
        }
    }

    /// One pixel clock.
    fn tick(&mut self, input: Option<Entering<'_>>) {
        if let Some(leaving) = self.core.clock(input) {
            self.banks.collect(leaving, self.pixel_clock);
        }
        self.pixel_clock += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixel clocks of a frame of four rows of 2048 samples. The last sample leaves the core 1036 clocks after it entered.
    fn clocks_of_a_frame(blanking: u16, gap_seed: u32) -> u64 {
        let options = Options::default();
        let mut player = Player::new(&options, None).unwrap();
        let mut tables = Tables::new(&options, None);
        player.configure(Settings { blanking, gap_seed, ..Settings::at_power_up(&options) }).unwrap();
        for row in 0..4 {
            let samples = vec![0; 2048];
            player.play(&RowIn { sequence: 0, frame: 0, row, last: row == 3, samples }, &mut tables).unwrap();
            player.banks.fetch();
        }
        player.flush();
        player.pixel_clock
    }

    #[test]
    fn blanking_stands_before_every_row_but_the_first() {
        assert_eq!(clocks_of_a_frame(0, 0), 4 * 2048 + 1036);
        assert_eq!(clocks_of_a_frame(100, 0), 4 * 2048 + 1036 + 3 * 100);
    }

    /// The seed 1 adds 7, 7 and 6 clocks before rows 1 to 3, as drawn in Python.
    #[test]
    fn a_seed_adds_blanking_before_every_row_but_the_first() {
        assert_eq!(clocks_of_a_frame(100, 1), clocks_of_a_frame(100, 0) + 7 + 7 + 6);
    }
}
