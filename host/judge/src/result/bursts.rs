//! What findings on bursts, frames that the board makes on its own, say beside their figures.

use halfrow_model::TableSet;
use serde::{Deserialize, Serialize};

/// Why there was no burst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum NoBurst {
    /// Nobody asked for one.
    NotAskedFor {},
    /// It is none of the parts that the run was to judge.
    LeftOut {},
    /// The board makes no frames on its own.
    BoardMakesNone {},
    /// It makes others than this program knows.
    ContentUnknown {
        /// Its content id.
        content: u16,
        /// The one that is known.
        known: u16,
    },
}

/// Settings that no plan has, at which a board made frames on its own.
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
    /// Whether its tables are a grid by turns with row factors, not row factors alone.
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

/// Frames that the board made on its own, all of them right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualAtSpeed {
    /// Frames.
    pub frames: u32,
    /// The pixel clock that the board names, in hertz; 0 when it names none.
    pub clock_hz: u32,
    /// What was seen of that clock.
    #[serde(default)]
    pub seen: ClockSeen,
    /// How long they took on that clock, in seconds.
    pub seconds: Option<f64>,
    /// Frames that waited until the host had the records of earlier ones.
    pub held_back: u32,
    /// Other settings at which frames were equal as well.
    #[serde(default)]
    pub corners: u32,
}

/// Between what a pixel clock was seen to be. No delay of host or link moves a bound past the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClockSeen {
    /// The least that it can be, in hertz; none if that was not seen.
    pub least_hz: Option<u32>,
    /// The most that it can be, in hertz; none if that was not seen.
    pub most_hz: Option<u32>,
}

impl ClockSeen {
    /// By how many parts of it a named clock may be off, which is far more than crystals are.
    const TOLERANCE: u64 = 5;

    /// Whether a clock of `named` hertz can be meant by what was seen.
    pub(crate) fn allows(self, named: u32) -> bool {
        let more = |hertz: u32| u64::from(hertz) * (Self::TOLERANCE + 1);
        let times = |hertz: u32| u64::from(hertz) * Self::TOLERANCE;
        self.least_hz.is_none_or(|least| times(least) <= more(named))
            && self.most_hz.is_none_or(|most| times(named) <= more(most))
    }

    /// Whether both bounds are as near to `named` hertz as a clock of that may be seen.
    pub(crate) fn confirms(self, named: u32) -> bool {
        is_near(self.least_hz, named) && is_near(self.most_hz, named)
    }

    /// Whether each bound by which `wrong` rules out a clock of `named` hertz was seen here, as near to that as it may be.
    pub(crate) fn clears(self, wrong: Self, named: u32) -> bool {
        let is_fast = !Self { most_hz: None, ..wrong }.allows(named);
        let is_slow = !Self { least_hz: None, ..wrong }.allows(named);
        self.allows(named)
            && (!is_fast || is_near(self.least_hz, named))
            && (!is_slow || is_near(self.most_hz, named))
    }
}

/// Whether there is a `bound`, and a clock of `named` hertz may be that.
fn is_near(bound: Option<u32>, named: u32) -> bool {
    bound.is_some_and(|hertz| ClockSeen { least_hz: Some(hertz), most_hz: Some(hertz) }.allows(named))
}

/// What making a frame again has shown that was wrong at speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
pub enum Repetition {
    /// Its signature told enough.
    NotNeeded {},
    /// The board cannot keep a row that differs.
    NoTrap {},
    /// It was right every time.
    AllRight {
        /// How often.
        frames: u32,
    },
    /// It was wrong again, and a row of it was kept.
    Trapped {
        /// Frames up to the first that was wrong.
        frames: u32,
        /// The row.
        row: usize,
        /// What came back of the frame up to it where that was streamed.
        #[serde(default)]
        streamed: Streamed,
    },
    /// It was wrong again, and no row that differs was kept.
    NothingTrapped {
        /// Frames up to the first that was wrong.
        frames: u32,
    },
    /// It could not be made again.
    Impossible {},
}

impl Repetition {
    /// What is known of the frame at any other clock.
    pub(crate) fn streamed(self) -> Streamed {
        match self {
            Self::Trapped { streamed, .. } => streamed,
            _ => Streamed::NotTried,
        }
    }
}

/// What came back where a frame was streamed, row by row, that is wrong at speed.
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
}

/// What a board counts of a frame that it made on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BurstCount {
    /// Samples.
    Samples,
    /// Rows.
    Rows,
    /// The smallest latency.
    LeastLatency,
    /// The largest.
    MostLatency,
    /// The generation of its tables.
    Generation,
    /// Records of the burst, of which each frame has one.
    Records,
}
