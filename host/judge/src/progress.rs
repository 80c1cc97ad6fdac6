//! Progress of a long run, for whoever watches it.
//!
//! A run reports its [`Event`]s to a [`Progress`], on the run's own thread. Any closure that takes an event is one, so another
//! thread can watch through a channel:
//!
//! ```
//! use halfrow::progress::{Event, Progress};
//!
//! let (sender, events) = std::sync::mpsc::channel();
//! let watched = move |event: Event| {
//!     // It is no error if nobody listens to the end.
//!     let _ = sender.send(event);
//! };
//! watched.row();
//! assert_eq!(events.recv(), Ok(Event::Rows(1)));
//! ```

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::result::SoakLength;

/// What a run reports while it works.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A step that moves no rows begins.
    Step(Step),
    /// This many more rows will come back.
    RowsExpected(u64),
    /// The frame with this name is being sent.
    Frame(String),
    /// This many rows came back, or were computed, since the last event of this kind.
    Rows(u64),
    /// Frames that the board makes by itself were judged.
    AtSpeed(JudgedAtSpeed),
    /// Frames of a soak were judged.
    Soaked(Soaked),
    /// The run is over, in whatever way. A plan that is refused before the board is asked sends no event at all.
    Done,
}

/// How many frames of a burst were judged. Its text may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JudgedAtSpeed {
    /// Frames judged.
    pub frames: u32,
    /// The frames of the whole burst.
    pub of: u32,
}

impl fmt::Display for JudgedAtSpeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} of {}", Step::AtSpeed, self.frames, self.of)
    }
}

/// How far a soak has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soaked {
    /// Time since it began, on the link's clock.
    pub time: Duration,
    /// Frames judged.
    pub frames: u64,
    /// The frames among them that differ, or of which the board counts something wrong.
    pub wrong: u64,
    /// The planned length.
    pub of: SoakLength,
}

impl Soaked {
    /// The share that is done, 0 to 1.
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// The reference computes results that another program has computed before.
    #[serde(rename = "judge")]
    JudgeTheJudge,
    /// The session with the board is opened.
    #[serde(rename = "open")]
    OpenTheBoard,
    /// Bytes go to the board and come back.
    #[serde(rename = "link")]
    TestTheLink,
    /// The board makes frames by itself.
    AtSpeed,
    /// Requests that must be refused are tried.
    Rules,
    /// Everything is done again, since a late copy of a request may have spoilt it.
    LookAgain,
    /// The board went away, and the run waits for it.
    #[serde(rename = "wait")]
    WaitForTheBoard,
}

impl Step {
    /// Its name: stable, lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::JudgeTheJudge => "judge",
            Self::OpenTheBoard => "open",
            Self::TestTheLink => "link",
            Self::AtSpeed => "at-speed",
            Self::Rules => "rules",
            Self::LookAgain => "look-again",
            Self::WaitForTheBoard => "wait",
        }
    }
}

/// In words for people, which may change.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::JudgeTheJudge => "checking this computer",
            Self::OpenTheBoard => "opening the board",
            Self::TestTheLink => "testing the link",
            Self::AtSpeed => "frames at the full pixel clock",
            Self::Rules => "what the board must refuse",
            Self::LookAgain => "testing again, in a new session",
            Self::WaitForTheBoard => "waiting for the board to come back",
        })
    }
}

/// Receives what a run reports. It must not block, since the board waits meanwhile.
pub trait Progress: Sync {
    /// Something happened.
    fn event(&self, event: Event);

    /// A step that moves no rows begins.
    fn step(&self, step: Step) {
        self.event(Event::Step(step));
    }

    /// This many more rows will come back.
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

    /// This many rows came back, or were computed, at once.
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

/// Ignores every event.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn event(&self, _: Event) {}
}
