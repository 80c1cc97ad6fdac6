//! What a build of the board has: the constants that synthesis fixes and the board advertises.

use halfrow_pipe::{BoardOptions, Fault, Limits, ValueError, parse_word};

use crate::depth::Depth;
use crate::faults::{BoardFault, FAULTS};

const LATENCY: Limits = Limits::new("latency", 4, MOST_LATENCY as i64);
const MOST_LATENCY: u8 = 32;
const RING: Limits = Limits::new("ring", 64, 16384);
const LEAST_BLANKING: Limits = Limits::new("least-blanking", 0, 4095);
const ROW_BANKS_IN: Limits = Limits::new("row-banks-in", 2, 255);
const ROW_BANKS_OUT: Limits = Limits::new("row-banks-out", 2, 255);
const TABLE_BANKS: Limits = Limits::new("table-banks", 1, 2);
const MAX_WIDTH: Limits = Limits::new("max-width", 64, 2592);
const MAX_HEIGHT: Limits = Limits::new("max-height", 1, 2048);
const PIXEL_CLOCK: Limits = Limits::new("pixel-clock", 1, 1_000_000_000);
const RECORDS: Limits = Limits::new("records", 2, 65535);
const LEAST_FRAME_BLANKING: Limits = Limits::new("least-frame-blanking", 0, 4095);
const ENTRIES: Limits = Limits::new("entries", LEAST_ENTRIES as i64, 65535);
/// The fewest entries of a bank that can hold a grid.
const LEAST_ENTRIES: u16 = 2048;
/// As wide as the number of a Spartan-6, which has 57 bits.
const SERIAL: Limits = Limits::new("serial", 0, (1 << 57) - 1);

/// The name of the option that sets the number of taps.
const TAPS: &str = "taps";

/// The name of the option that lists the depths, as in `depths=8+12`.
const DEPTHS: &str = "depths";

/// The name of the option that says whether a board makes bursts.
const BURSTS: &str = "bursts";

/// The name of the option that says whether rows come back with the CRC-32 of what entered.
const ENTERED: &str = "entered";

/// The name of the option that says whether the board takes grids.
const DATAPATH2: &str = "datapath2";

const TRUTHS: &[(&str, bool)] = &[("no", false), ("yes", true)];

const BURST_BUILDS: &[(&str, BurstBuild)] =
    &[("no", BurstBuild::None), ("untrapped", BurstBuild::Untrapped), ("trapped", BurstBuild::Trapped)];

/// An option that no build can have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OptionError {
    /// One option by itself is wrong.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// The mock board's ring must be a power of two long: otherwise its addresses would not wrap correctly.
    #[error("ring={ring} is not a power of two; give one from 64 to 16384")]
    RingNotPowerOfTwo {
        /// Samples in the ring.
        ring: u16,
    },
    /// The mock board's ring is too short for a row of its greatest width.
    #[error(
        "ring={ring} is shorter than a row of max-width={max_width}; make the ring larger or the width less"
    )]
    RingTooShort {
        /// Samples in the ring.
        ring: u16,
        /// Columns of the widest row.
        max_width: u16,
    },
    /// The mock board's greatest width is odd: rows have an even width, since colours come in pairs.
    #[error("max-width={max_width} is odd; give an even one")]
    OddWidth {
        /// Columns of the widest row.
        max_width: u16,
    },
    /// The list of the mock board's sample depths is empty.
    #[error("depths is empty; give at least one of 8, 10 and 12")]
    NoDepth,
    /// The fault is of an address line that this mock board's ring does not have.
    #[error("the ring has no address line bit={bit}; give one from 0 to {last}, or a longer ring")]
    NoAddressLine {
        /// The line that the fault would break.
        bit: u8,
        /// The highest line of the ring.
        last: u32,
    },
    /// The fault is of a tap that a build of five taps does not have.
    #[error("a build of five taps has no {key}={tap}; give one from 1 to 5, or leave taps=five out")]
    NoTap {
        /// The parameter of the fault that names the tap.
        key: &'static str,
        /// The tap.
        tap: u8,
    },
    /// The fault is of a kernel word that a build of five taps does not have.
    #[error("a build of five taps has no weight={weight}; give r1, g4 or r5, or leave taps=five out")]
    NoWeight {
        /// The weight whose word the fault would spoil.
        weight: &'static str,
    },
    /// The fault claims a latency one pixel clock too long, but no mock board may claim more than this one has.
    #[error(
        "the fault claims latency={claimed}, and no board may claim more than {most}; give a shorter latency, or another fault"
    )]
    NoLongerLatency {
        /// The latency that the board would claim.
        claimed: u8,
        /// The longest possible one.
        most: u8,
    },
    /// The fault confuses the two banks of tables, but this mock board has only one.
    #[error("the fault takes the wrong one of two banks of tables; give table-banks=2, or another fault")]
    NoOtherBank,
    /// The fault is in frames that the board makes itself, but this mock board makes none.
    #[error(
        "the fault strikes in frames that the board makes itself; leave bursts=no out, or give another fault"
    )]
    NoBursts,
}

/// How many taps a build has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapCount {
    /// R1 to R5: enough for Hermite, linear and nearest, not for Keys.
    Five,
    /// G0 to G6: any kernel.
    Seven,
}

/// Whether a build makes frames of its own (`fpga/AT-SPEED.md`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BurstBuild {
    /// It does not.
    None,
    /// It does, but without a trap.
    Untrapped,
    /// It does, with a trap.
    Trapped,
}

/// The constants of a build.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// L: pixel clocks beyond half a row until an output leaves, 4 to 32; three are look-ahead, the rest is the pipeline.
    pub latency: u8,
    /// M: samples in the ring, a power of two; none for the smallest that holds the widest row.
    pub ring: Option<u16>,
    /// Pixel clocks that the build needs between rows, 0 to 4095.
    pub least_blanking: u16,
    /// Rows that can wait to be played, 2 to 255.
    pub row_banks_in: u8,
    /// Rows that have been played and can wait to be fetched, 2 to 255.
    pub row_banks_out: u8,
    /// Banks of tables, 1 or 2. With one bank, rows use the same tables that are written.
    pub table_banks: u8,
    /// Taps of the core.
    pub taps: TapCount,
    /// Columns of the widest row, even, 64 to 2592.
    pub max_width: u16,
    /// Rows of the tallest frame, 1 to 2048.
    pub max_height: u16,
    /// The depths that the board can be set to.
    pub depths: Vec<Depth>,
    /// The pixel clock in Hz, 1 to 10^9. It is reported to the host but has no other effect.
    pub pixel_clock: u32,
    /// The FPGA's own number, below 2^57; 0 for none.
    pub serial: u64,
    /// Whether the board makes bursts.
    pub bursts: BurstBuild,
    /// Records of bursts that are kept, 2 to 65535.
    pub records: u16,
    /// Pixel clocks that the build needs between the frames of a burst, 0 to 4095.
    pub least_frame_blanking: u16,
    /// Whether rows come back with the CRC-32 of what entered.
    pub entered: bool,
    /// Whether the board takes grids: `fpga/DATAPATH.md`, *Datapath 2*.
    pub datapath2: bool,
    /// Entries of a bank, 2048 to 65535, raised to the height of the tallest frame. Those beyond that height serve only grids.
    pub entries: u16,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            latency: 12,
            ring: None,
            least_blanking: 0,
            row_banks_in: 4,
            row_banks_out: 4,
            table_banks: 2,
            taps: TapCount::Seven,
            max_width: 2048,
            max_height: 2048,
            depths: Depth::ALL.to_vec(),
            pixel_clock: 96_000_000,
            serial: 0,
            bursts: BurstBuild::Trapped,
            records: 64,
            least_frame_blanking: 8,
            entered: true,
            datapath2: true,
            entries: LEAST_ENTRIES,
        }
    }
}

impl Options {
    /// Samples M in the ring.
    #[must_use]
    pub fn ring_size(&self) -> u16 {
        self.ring.unwrap_or_else(|| self.max_width.checked_next_power_of_two().unwrap_or(u16::MAX))
    }

    /// T: entries of a bank, at least one for each row of the tallest frame.
    #[must_use]
    pub(crate) fn bank_entries(&self) -> u16 {
        self.entries.max(self.max_height)
    }

    /// Checks that the board may claim a latency one pixel clock longer than it has.
    pub(crate) fn check_longer_latency(&self) -> Result<(), OptionError> {
        if self.latency < MOST_LATENCY {
            return Ok(());
        }
        Err(OptionError::NoLongerLatency { claimed: self.latency.saturating_add(1), most: MOST_LATENCY })
    }

    /// Checks whether a build with these options can exist.
    ///
    /// # Errors
    /// The first option that is out of range or does not fit another.
    pub fn check(&self) -> Result<(), OptionError> {
        LATENCY.check(self.latency.into())?;
        LEAST_BLANKING.check(self.least_blanking.into())?;
        ROW_BANKS_IN.check(self.row_banks_in.into())?;
        ROW_BANKS_OUT.check(self.row_banks_out.into())?;
        TABLE_BANKS.check(self.table_banks.into())?;
        MAX_WIDTH.check(self.max_width.into())?;
        MAX_HEIGHT.check(self.max_height.into())?;
        PIXEL_CLOCK.check(self.pixel_clock.into())?;
        SERIAL.check(i64::try_from(self.serial).unwrap_or(i64::MAX))?;
        RECORDS.check(self.records.into())?;
        LEAST_FRAME_BLANKING.check(self.least_frame_blanking.into())?;
        ENTRIES.check(self.entries.into())?;
        let (ring, max_width) = (self.ring_size(), self.max_width);
        RING.check(ring.into())?;
        if !ring.is_power_of_two() {
            return Err(OptionError::RingNotPowerOfTwo { ring });
        }
        if ring < max_width {
            return Err(OptionError::RingTooShort { ring, max_width });
        }
        if max_width % 2 != 0 {
            return Err(OptionError::OddWidth { max_width });
        }
        if self.depths.is_empty() { Err(OptionError::NoDepth) } else { Ok(()) }
    }
}

impl BoardOptions for Options {
    type Fault = BoardFault;

    const KEYS: &'static [&'static str] = &[
        LATENCY.key(),
        RING.key(),
        LEAST_BLANKING.key(),
        ROW_BANKS_IN.key(),
        ROW_BANKS_OUT.key(),
        TABLE_BANKS.key(),
        TAPS,
        MAX_WIDTH.key(),
        MAX_HEIGHT.key(),
        DEPTHS,
        PIXEL_CLOCK.key(),
        SERIAL.key(),
        BURSTS,
        RECORDS.key(),
        LEAST_FRAME_BLANKING.key(),
        ENTERED,
        DATAPATH2,
        ENTRIES.key(),
    ];

    const FAULTS: &'static [Fault<BoardFault>] = FAULTS;

    /// Only [`Options::check`] says whether options fit each other, so their order does not matter.
    fn set(&mut self, key: &str, value: &str) -> Result<bool, ValueError> {
        let is = |limits: &Limits| limits.key() == key;
        match key {
            TAPS => {
                self.taps = parse_word(TAPS, value, &[("five", TapCount::Five), ("seven", TapCount::Seven)])?;
            }
            DEPTHS => self.depths = parse_depths(value)?,
            BURSTS => self.bursts = parse_word(BURSTS, value, BURST_BUILDS)?,
            ENTERED => self.entered = parse_word(ENTERED, value, TRUTHS)?,
            DATAPATH2 => self.datapath2 = parse_word(DATAPATH2, value, TRUTHS)?,
            _ if is(&RING) => self.ring = Some(RING.parse(value)?),
            _ if is(&LATENCY) => self.latency = LATENCY.parse(value)?,
            _ if is(&LEAST_BLANKING) => self.least_blanking = LEAST_BLANKING.parse(value)?,
            _ if is(&ROW_BANKS_IN) => self.row_banks_in = ROW_BANKS_IN.parse(value)?,
            _ if is(&ROW_BANKS_OUT) => self.row_banks_out = ROW_BANKS_OUT.parse(value)?,
            _ if is(&TABLE_BANKS) => self.table_banks = TABLE_BANKS.parse(value)?,
            _ if is(&MAX_WIDTH) => self.max_width = MAX_WIDTH.parse(value)?,
            _ if is(&MAX_HEIGHT) => self.max_height = MAX_HEIGHT.parse(value)?,
            _ if is(&PIXEL_CLOCK) => self.pixel_clock = PIXEL_CLOCK.parse(value)?,
            _ if is(&SERIAL) => self.serial = SERIAL.parse(value)?,
            _ if is(&RECORDS) => self.records = RECORDS.parse(value)?,
            _ if is(&LEAST_FRAME_BLANKING) => {
                self.least_frame_blanking = LEAST_FRAME_BLANKING.parse(value)?;
            }
            _ if is(&ENTRIES) => self.entries = ENTRIES.parse(value)?,
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// The depths in a list like `8+12`.
fn parse_depths(text: &str) -> Result<Vec<Depth>, ValueError> {
    let known = [("8", Depth::Eight), ("10", Depth::Ten), ("12", Depth::Twelve)];
    text.split('+').map(|word| parse_word(DEPTHS, word, &known)).collect()
}
