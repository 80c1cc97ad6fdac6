//! What findings on bursts (frames that the board makes itself) hold besides plain figures.

use halfrow_model::TableSet;
use serde::{Deserialize, Serialize};

use crate::compare::Difference;

/// Why there was no burst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum NoBurst {
    /// Nobody asked for one.
    NotAskedFor {},
    /// It is not among the parts that the run was to judge.
    LeftOut {},
    /// The board does not make frames itself.
    BoardMakesNone {},
    /// It makes frames whose content this program does not know.
    ContentUnknown {
        /// Its content id.
        content: u16,
        /// The one that is known.
        known: u16,
    },
}

/// Settings that no streamed frame has, with which a board made frames itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Corner {
    /// W.
    pub width: usize,
    /// H.
    pub height: usize,
    /// Bits of a sample.
    pub bits: u32,
    /// C, twice the column of the centre.
    pub centre2: u32,
    /// Whether its tables are by turns a grid and row factors, not row factors alone.
    #[serde(default)]
    pub grid: bool,
}

impl From<&TableSet> for Corner {
    fn from(tables: &TableSet) -> Self {
        let geometry = tables.geometry();
        let (width, height, centre2) = (geometry.width(), geometry.height(), geometry.centre2());
        Self { width, height, bits: geometry.depth().bits(), centre2, grid: tables.shape().is_some() }
    }
}

/// Frames that the board made itself, all of them right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualAtSpeed {
    /// Frames.
    pub frames: u64,
    /// The pixel clock that the board names, in hertz; 0 when it names none.
    pub clock_hz: u32,
    /// What that clock was measured to be.
    #[serde(default)]
    pub seen: ClockSeen,
    /// How long the frames took on that clock, in seconds.
    pub seconds: Option<f64>,
    /// Frames that waited until the host had the records of earlier ones.
    pub held_back: u64,
    /// Other settings with which frames were equal too.
    #[serde(default)]
    pub corners: u32,
}

/// The bounds that were measured for a pixel clock. No delay of host or link moves a bound past the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClockSeen {
    /// The least that it can be, in hertz; none if not measured.
    pub least_hz: Option<u32>,
    /// The most that it can be, in hertz; none if not measured.
    pub most_hz: Option<u32>,
}

impl ClockSeen {
    /// A named clock may be off by one part in this many, which is far more than crystals are off.
    const TOLERANCE: u64 = 5;

    /// Whether the bounds allow a clock of `named` hertz, within the tolerance.
    pub(crate) fn allows(self, named: u32) -> bool {
        let more = |hertz: u32| u64::from(hertz) * (Self::TOLERANCE + 1);
        let times = |hertz: u32| u64::from(hertz) * Self::TOLERANCE;
        self.least_hz.is_none_or(|least| times(least) <= more(named))
            && self.most_hz.is_none_or(|most| times(named) <= more(most))
    }

    /// Whether both bounds exist and are within the tolerance of `named` hertz.
    pub(crate) fn confirms(self, named: u32) -> bool {
        is_near(self.least_hz, named) && is_near(self.most_hz, named)
    }

    /// Whether each bound by which `wrong` rules out a clock of `named` hertz was measured here within the tolerance.
    pub(crate) fn clears(self, wrong: Self, named: u32) -> bool {
        let is_fast = !Self { most_hz: None, ..wrong }.allows(named);
        let is_slow = !Self { least_hz: None, ..wrong }.allows(named);
        self.allows(named)
            && (!is_fast || is_near(self.least_hz, named))
            && (!is_slow || is_near(self.most_hz, named))
    }
}

/// Whether `bound` exists and is within the tolerance of a clock of `named` hertz.
fn is_near(bound: Option<u32>, named: u32) -> bool {
    bound.is_some_and(|hertz| ClockSeen { least_hz: Some(hertz), most_hz: Some(hertz) }.allows(named))
}

/// What was shown by making a frame again that had been wrong at speed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Repetition {
    /// Its signature was enough.
    NotNeeded {},
    /// The board has no trap: it cannot keep a row that differs.
    NoTrap {},
    /// It was right every time.
    AllRight {
        /// How often.
        frames: u32,
    },
    /// It was wrong again, or while it was repeated anyway, and a row of it was kept.
    Trapped {
        /// Frames up to and including the first wrong one.
        frames: u32,
        /// The row that was kept.
        row: usize,
        /// Whether it was wrong only while it was repeated, as in every other burst of a soak.
        #[serde(default)]
        only_there: bool,
        /// What came back when the frame was streamed up to that row.
        #[serde(default)]
        streamed: Streamed,
        /// What differs in that row; none where a report is of a version that did not tell.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        kept: Option<Box<KeptRow>>,
    },
    /// It was wrong again, or while it was repeated anyway, and no differing row was kept.
    NothingTrapped {
        /// Frames up to and including the first wrong one.
        frames: u32,
        /// As in [`Repetition::Trapped`].
        #[serde(default)]
        only_there: bool,
    },
    /// It was wrong again, or while it was repeated anyway, and what was kept has the number or the width of no row of it.
    NoSuchRow {
        /// Frames up to and including the first wrong one.
        frames: u32,
        /// As in [`Repetition::Trapped`].
        #[serde(default)]
        only_there: bool,
    },
    /// It was wrong again, or while it was repeated anyway, and a row was kept whose samples are right, and whose signature is
    /// not the CRC of them.
    SignedWrong {
        /// Frames up to and including the first wrong one.
        frames: u32,
        /// The row that was kept.
        row: usize,
        /// As in [`Repetition::Trapped`].
        #[serde(default)]
        only_there: bool,
    },
    /// It could not be made again.
    Impossible {},
}

impl Repetition {
    /// What is known of the frame when it does not run at the full pixel clock.
    pub(crate) fn streamed(&self) -> Streamed {
        match self {
            Self::Trapped { streamed, .. } => *streamed,
            Self::NotNeeded {}
            | Self::NoTrap {}
            | Self::AllRight { .. }
            | Self::NothingTrapped { .. }
            | Self::NoSuchRow { .. }
            | Self::SignedWrong { .. }
            | Self::Impossible {} => Streamed::NotTried,
        }
    }
}

/// A row that the board kept of a frame that was wrong at speed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptRow {
    /// The generation of the tables that made it.
    pub generation: u8,
    /// How many of its samples differ.
    pub differences: usize,
    /// The first of these, from left to right, at most [`Self::MOST`].
    pub first: Vec<Difference>,
}

impl KeptRow {
    /// The most samples that are told.
    pub const MOST: usize = 10;

    /// What differs in `row` of a frame made by `generation`, in which `expected` came out as `found`.
    pub(crate) fn new(generation: u8, row: usize, expected: &[u16], found: &[u16]) -> Self {
        let pairs = expected.iter().zip(found).enumerate();
        let differing = pairs.filter(|(_, (expected, found))| expected != found);
        let told = |(column, (&expected, &found))| Difference { row, column, expected, found };
        Self {
            generation,
            differences: differing.clone().count(),
            first: differing.map(told).take(Self::MOST).collect(),
        }
    }
}

/// What came back when a frame that is wrong at speed was streamed row by row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Streamed {
    /// It was not streamed.
    #[default]
    NotTried,
    /// It came back right.
    Right,
    /// It came back wrong, too.
    Wrong,
    /// This row of it did not come back.
    RowLost {
        /// Its number.
        row: u16,
    },
}

/// What a board counts of a frame that it made itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BurstCount {
    /// Samples.
    Samples,
    /// Rows.
    Rows,
    /// The smallest latency, in pixel clocks.
    LeastLatency,
    /// The largest latency, in pixel clocks.
    MostLatency,
    /// The generation of its tables.
    Generation,
    /// Records of the burst, one for each frame.
    Records,
}
