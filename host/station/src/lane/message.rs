//! What supervisor and lane say to each other: one JSON object per line.

use std::path::PathBuf;

use halfrow::progress::{JudgedAtSpeed, Step};
use halfrow::verdict::StoppedBy;
use serde::{Deserialize, Serialize};

use crate::record::{BoardSeen, StepRecord};
use crate::said::Said;

/// The longest line that a lane may report, in bytes. The report of a step is most of it: a frame that differs takes some 15 kB
/// of it at 1920 columns.
pub(crate) const MOST_LINE: usize = 32 << 20;

/// What the lane is to do: the first line that it reads.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaneJob {
    /// The run.
    pub run: String,
    /// The target string of the board.
    pub target: String,
    /// The file of the plan, to which its paths are relative.
    pub plan: PathBuf,
    /// The plan's text.
    pub text: String,
    /// The hash of the plan and its files.
    pub sha256: String,
    /// The variant.
    pub variant: String,
    /// The seed of the run.
    pub seed: u64,
    /// Whether the board is the mock in the place of a unit that is known to be bad: it is neither hardware nor of a
    /// released build, and limits do not apply to it.
    pub is_mock: bool,
    /// The folder for what is kept of the run.
    pub spool: PathBuf,
    /// How much memory the lane may have, in MiB of addresses.
    pub memory_mib: u64,
}

/// What the lane reads after its job.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Control {
    /// The run is to end.
    Stop(StoppedBy),
    /// The answer to [`Message::Identified`].
    Device(Ruling),
}

/// Whether a device may be judged under the serial number of the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ruling {
    /// It may: neither was seen before.
    New,
    /// It may: they belong together.
    Known,
    /// It may not: somebody mixed boards up.
    Refused {
        /// Why.
        why: Said,
    },
    /// It could not be found out.
    Untold {
        /// Why.
        why: Said,
    },
}

/// What the lane reports.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "told", rename_all = "kebab-case")]
pub enum Message {
    /// The lane has its job: the first message.
    Begun {
        /// Its program, as records name it.
        program: String,
    },
    /// A try of a step begins.
    Step {
        /// The step's place, from 1.
        seq: u32,
        /// The try, from 1.
        attempt: u32,
        /// The step's name.
        name: String,
    },
    /// The board said which device it is; no frame is sent before [`Control::Device`] answers.
    Identified {
        /// The board.
        board: BoardSeen,
    },
    /// The frame of this name is being sent.
    Frame {
        /// The name.
        name: String,
    },
    /// The judge begins a step of its own.
    Judging {
        /// Which.
        step: Step,
    },
    /// Frames that the board makes by itself were judged.
    AtSpeed(JudgedAtSpeed),
    /// Rows that came back so far.
    Rows {
        /// How many.
        done: u64,
        /// Of how many.
        expected: u64,
    },
    /// A try of a step is over.
    Ended {
        /// What it came to.
        step: Box<StepRecord>,
    },
    /// All is done: the last message.
    Done,
    /// The job cannot be done; this is the last message, too.
    Refused {
        /// Why, and what to do.
        why: Said,
    },
}
