//! Progress of a long run, for whoever watches.
//!
//! A run tells its [`Event`]s to a [`Progress`], on the thread that it runs on. Any closure that takes an event is one, so
//! that another thread watches by a channel:
//!
//! ```
//! use halfrow::progress::{Event, Progress};
//!
//! let (sender, events) = std::sync::mpsc::channel();
//! let watched = move |event: Event| {
//!     // Nobody needs to listen to the end.
//!     let _ = sender.send(event);
//! };
//! watched.row();
//! assert_eq!(events.recv(), Ok(Event::Rows(1)));
//! ```

use std::fmt;
use std::time::Duration;

use crate::result::SoakLength;

/// What a run does, as it does it.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A step begins that moves no rows.
    Step(Step),
    /// So many further rows will come back.
    RowsExpected(u64),
    /// The frame with this name is being sent.
    Frame(String),
    /// As many rows came back, or were computed, since the last event of this kind.
    Rows(u64),
    /// Frames of a soak were judged.
    Soaked(Soaked),
    /// The run is over.
    Done,
}

/// How far a soak is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soaked {
    /// Since it began, on the link's clock.
    pub time: Duration,
    /// Frames judged.
    pub frames: u64,
    /// Those that differ.
    pub wrong: u64,
    /// How long it is to be.
    pub of: SoakLength,
}

impl Soaked {
    /// The share of it that is done, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        let (done, all) = match self.of {
            SoakLength::Time { seconds } => (self.time.as_secs_f64(), seconds),
            SoakLength::Frames { frames } => (self.frames as f64, frames as f64),
        };
        if all > 0.0 { (done / all).min(1.0) } else { 1.0 }
    }
}

/// A step of a run that moves no rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The reference computes what another program has computed before.
    JudgeTheJudge,
    /// The session with the board is opened.
    OpenTheBoard,
    /// Bytes go to the board and come back.
    TestTheLink,
    /// The board makes frames on its own.
    AtSpeed,
    /// What must be refused is tried.
    Rules,
    /// Everything is done again, since an old copy of a request may have spoilt it.
    LookAgain,
    /// The board went away, and the run waits for it.
    WaitForTheBoard,
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::JudgeTheJudge => "judging the judge",
            Self::OpenTheBoard => "opening the board",
            Self::TestTheLink => "testing the link",
            Self::AtSpeed => "frames at the full pixel clock",
            Self::Rules => "what the board must refuse",
            Self::LookAgain => "testing again, in a new session",
            Self::WaitForTheBoard => "waiting for the board to come back",
        })
    }
}

/// Told what a run does. It must not block, for the board waits meanwhile.
pub trait Progress: Sync {
    /// Something happened.
    fn event(&self, event: Event);

    /// A step begins that moves no rows.
    fn step(&self, step: Step) {
        self.event(Event::Step(step));
    }

    /// So many further rows will come back.
    fn rows_expected(&self, rows: u64) {
        self.event(Event::RowsExpected(rows));
    }

    /// A frame is being sent.
    fn frame(&self, name: &str) {
        self.event(Event::Frame(name.to_owned()));
    }

    /// A row came back.
    fn row(&self) {
        self.rows(1);
    }

    /// As many rows came back, or were computed, at once.
    fn rows(&self, count: u64) {
        self.event(Event::Rows(count));
    }

    /// The run is over.
    fn done(&self) {
        self.event(Event::Done);
    }
}

impl<F: Fn(Event) + Sync> Progress for F {
    fn event(&self, event: Event) {
        self(event);
    }
}

/// Says nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn event(&self, _: Event) {}
}
