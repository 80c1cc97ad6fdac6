//! What a run found: one structure, of which the text, JSON, JUnit and HTML are views.

mod folder;
mod html;
mod identity;
mod json;
mod junit;
mod pictures;
mod sha256;
pub mod wording;

use halfrow_model::Frame;
use serde::Serialize;

use crate::compare::Comparison;
use crate::frames::street::EdgeDeviation;
use crate::link::LineErrors;
use crate::verdict::{Cause, Verdict};

pub use crate::target::BoardKind;
pub use folder::{JsonView, ReportError, ReportFolder};
pub use html::document;
pub use html::render as html;
pub use identity::Identity;
pub use json::render as json;
pub use junit::render as junit;
pub use sha256::sha256;

/// A finished run of `verify`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The judgement.
    pub verdict: Verdict,
    /// The board.
    pub board: BoardReport,
    /// Why the verdict is what it is.
    pub cause: Cause,
    /// The result in one sentence.
    pub headline: String,
    /// What to do next, when there is something to do.
    pub remedy: Option<String>,
    /// The parts that the pattern of differences points at, the likeliest first.
    pub suspects: Vec<Suspect>,
    /// Every check, in the order of the run.
    pub checks: Vec<Check>,
    /// Every frame that was streamed, in order.
    pub frames: Vec<FrameReport>,
    /// The latency of all rows.
    pub latency: Option<LatencyReport>,
    /// How façade edges of the built-in street stand before and after.
    pub street: Option<StreetReport>,
    /// What was kept for diagnosis and pictures.
    pub evidence: EvidenceReport,
    /// The link.
    pub link: LinkReport,
    /// What was uploaded.
    pub tables: TablesReport,
    /// The run itself: enough to repeat it.
    pub run: RunReport,
}

/// Which board it was.
#[derive(Clone, Debug, Serialize)]
pub struct BoardReport {
    /// `mock`, `sim`, `replay` or `hardware`.
    pub kind: BoardKind,
    /// The target string.
    pub target: String,
    /// What the board says of itself; none when it never answered.
    pub identity: Option<Identity>,
}

/// One thing that was checked.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Its name: stable, short, lower case.
    pub name: &'static str,
    /// How it came out.
    pub outcome: Outcome,
    /// What was seen, in one sentence.
    pub detail: String,
}

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// As it should be.
    Passed,
    /// The board is wrong.
    Failed,
    /// It could not be checked.
    Error,
    /// It was not reached.
    Skipped,
}

/// One streamed frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameReport {
    /// `builtin:NAME`, or the file's path.
    pub name: String,
    /// The frame's number on the wire.
    pub number: u16,
    /// SHA-256 of the samples, 16 bits little endian.
    pub sha256: String,
    /// Bayer phase.
    pub phase: String,
    /// Which tables made it: a generation.
    pub generation: u8,
    /// How its rows were played, for people: `least blanking (0)`, `900 clocks`, `gaps, seed 7`.
    pub timing: String,
    /// How it compares.
    pub comparison: Comparison,
    /// Rows that came back.
    pub rows: usize,
}

/// The part that a pattern of differences points at.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suspect {
    /// What is suspected: stable, lower case, as `row factor`, `data bit`, `address bit`.
    pub part: &'static str,
    /// Where: row, node and weight, bit, as far as it can be told.
    pub place: String,
    /// Why, in one sentence.
    pub evidence: String,
    /// What to do next, in one sentence.
    pub next_step: String,
    /// The share of the differing samples that it explains exactly, 0 to 1.
    pub explained: f64,
}

/// The latency of every row, in pixel clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct LatencyReport {
    /// D = W/2 + L by the board's own L.
    pub claimed: u32,
    /// The most that any board may take, W/2 + 32.
    pub limit: u32,
    /// The smallest that was measured.
    pub least: u32,
    /// The largest.
    pub most: u32,
    /// Rows measured.
    pub rows: usize,
    /// Rows whose first or last latency is not the claimed one.
    pub wrong_rows: usize,
}

/// Façade edges of the built-in street.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StreetReport {
    /// As the lens bends them.
    pub before: EdgeDeviation,
    /// As the board's correction leaves them.
    pub after: EdgeDeviation,
}

/// Frames kept for diagnosis and pictures: what went in, what came out and what should have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct EvidenceReport {
    /// Frames kept.
    pub kept: usize,
    /// Their bytes in memory.
    pub bytes: u64,
    /// Frames for which there was no room.
    pub left_out: usize,
}

/// What the link did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LinkReport {
    /// The link, for people.
    pub name: String,
    /// Bytes written.
    pub bytes_out: u64,
    /// Bytes read.
    pub bytes_in: u64,
    /// Packets written, retries included.
    pub packets_out: u64,
    /// Packets read whole.
    pub packets_in: u64,
    /// Packets that came damaged.
    pub damaged_in: u64,
    /// Packets that the board got damaged, by its own count.
    pub damaged_out: u64,
    /// Packets sent again.
    pub retries: u64,
    /// What the chip at the link's near end has seen go wrong on the line.
    pub line_errors: LineErrors,
    /// Retries from which on the link is too poor to judge over.
    pub retry_limit: u64,
    /// The round trip of an empty request, in microseconds of the link's clock.
    pub round_trip_us: Option<u64>,
    /// The time that the run took on the link's clock, in seconds.
    pub seconds: f64,
    /// Every time that the board went away and came back, in order.
    pub reconnections: Vec<Reconnection>,
}

/// A board that went away during the run and came back.
#[derive(Clone, Debug, Serialize)]
pub struct Reconnection {
    /// How it went, and what was under way.
    pub reason: String,
    /// How long it was away, in seconds.
    pub seconds_away: f64,
}

/// What was uploaded.
#[derive(Clone, Debug, Serialize)]
pub struct TablesReport {
    /// Where they came from: a file, or the lens and kernel in words.
    pub source: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bits a sample.
    pub bits: u32,
    /// C, twice the optical centre's column.
    pub centre2: u32,
    /// Rows outside the image circle, which are not stretched; none when the tables are a file, which does not say.
    pub rows_outside_circle: Option<usize>,
    /// CRC-32 of the row factors, as on the wire.
    pub steps_crc32: String,
    /// CRC-32 of the kernel's nodes, as on the wire.
    pub kernel_crc32: String,
}

/// The run itself.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// halfrow's version.
    pub version: &'static str,
    /// The commit that it was built from.
    pub commit: &'static str,
    /// The command line.
    pub arguments: Vec<String>,
    /// Seed of the run's nonces and link test.
    pub seed: u64,
    /// When it began, RFC 3339, UTC.
    pub started: String,
    /// When it ended.
    pub ended: String,
    /// How long it took by the wall's clock, in seconds.
    pub seconds: f64,
    /// The host it ran on.
    pub host: String,
    /// Files that were read, with their SHA-256.
    pub files: Vec<FileHash>,
}

/// A file that was read.
#[derive(Clone, Debug, Serialize)]
pub struct FileHash {
    /// Its path, as given.
    pub path: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

/// A frame kept for pictures: how it went in, what came out, what should have.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Index into [`Report::frames`].
    pub index: usize,
    /// What went in.
    pub input: Frame,
    /// What the board gave; rows that did not come back are black.
    pub found: Frame,
    /// What the reference gives.
    pub expected: Frame,
}
