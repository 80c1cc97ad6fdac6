//! What a run came to, as data: a [`Report`] that can be stored, read back and compared.
//!
//! ```text
//! Report ─► checks ─► Finding  ─┐
//!        ─► suspects ► Defect  ─┴─► wording ─► sentences, which the views print and the JSON carries
//! ```
//!
//! A finding is a code with parameters. Its sentence is made from them in [`wording`] and nowhere else; what is read back
//! is the code and its parameters, never the sentence.

mod as_text;
mod bursts;
mod check;
pub mod codes;
pub(crate) mod comparison;
mod counter;
mod coverage;
mod defect;
mod document;
mod doubt;
mod evidence;
pub mod examples;
mod extent;
mod finding;
mod frames;
mod identity;
mod late_rows;
mod link;
mod not_exercised;
mod problem;
mod rule;
mod sha256;
mod soak;
mod suspect;
mod within;
pub mod wording;

use serde::{Deserialize, Deserializer, Serialize, de};

use crate::board::Board;
use crate::frames::street::EdgeDeviation;
use crate::verdict::{Cause, Verdict};
use not_exercised::InWords;

pub use crate::target::BoardKind;
pub use bursts::{BurstCount, ClockSeen, Corner, EqualAtSpeed, NoBurst, Repetition, Streamed};
pub use check::{Check, CheckName, Outcome};
pub use counter::Counter;
pub use coverage::CoverageReport;
pub use defect::{
    ClampEnd, Counting, Defect, FlippedBit, Instead, MadeWith, Memory, Reading, RowSource, StaleFrames,
};
pub use document::{Document, SCHEMA, Schema};
pub use doubt::{BrokenOff, Doubt};
pub use evidence::{Evidence, EvidenceReport};
pub use extent::Extent;
pub use finding::Finding;
pub use frames::{FrameReport, FrameTiming, FrameTotals, LatencyReport, Variation};
pub use identity::{BurstsReport, Identity};
pub use late_rows::LateRows;
pub use link::{LinkReport, Reconnection};
pub use not_exercised::NotExercised;
pub use problem::{Parameters, Problem};
pub use rule::{Answer, NumberedRow, RepeatedRow, Rule};
pub use sha256::sha256;
pub use soak::{SoakChart, SoakDifference, SoakInterval, SoakLength, SoakReport};
pub use suspect::{Account, Suspect};
pub use within::{CoveragePoint, WithinPart, WithinReport};

/// A finished run of `verify` or `soak`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub struct Report {
    /// Which shape of JSON it has.
    pub schema: Schema,
    /// The board.
    pub board: BoardReport,
    /// Why it ended as it did. The verdict follows from it.
    pub cause: Cause,
    /// The result.
    pub finding: Finding,
    /// The parts that the pattern of differences points at, the likeliest first.
    pub suspects: Vec<Suspect>,
    /// Every check, in the order of the run.
    pub checks: Vec<Check>,
    /// Every frame that was streamed, in order.
    pub frames: Vec<FrameReport>,
    /// What the frames left untouched of the board, under PASS; empty under FAIL and ERROR.
    #[serde(default)]
    pub not_exercised: Vec<NotExercised>,
    /// The latency of all rows.
    pub latency: Option<LatencyReport>,
    /// How façade edges of the built-in street stand before and after.
    pub street: Option<StreetReport>,
    /// What was kept for diagnosis and pictures.
    pub evidence: EvidenceReport,
    /// Frames at the full pixel clock for hours; none but where they were asked for.
    #[serde(default)]
    pub soak: Option<SoakReport>,
    /// What was taken of the run, where it had to keep within a time.
    #[serde(default)]
    pub within: Option<WithinReport>,
    /// What share of the Verilog's faults the run finds, under PASS; none when that was not measured.
    #[serde(default)]
    pub coverage: Option<CoverageReport>,
    /// What was asked for and could not be written, under a verdict that stands without it.
    #[serde(default)]
    pub lacks: Vec<Problem>,
    /// The link.
    pub link: LinkReport,
    /// What was uploaded.
    pub tables: TablesReport,
    /// The run itself: enough to repeat it.
    pub run: RunReport,
}

impl Report {
    /// The judgement.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.cause.verdict()
    }

    /// The command that makes such a report.
    #[must_use]
    pub fn command(&self) -> &'static str {
        if self.soak.is_some() { "soak" } else { "verify" }
    }

    /// The result in one sentence.
    #[must_use]
    pub fn headline(&self) -> String {
        self.finding.sentence()
    }

    /// What to do next, when there is something to do: what the likeliest suspect asks for, or else the finding.
    #[must_use]
    pub fn remedy(&self) -> Option<String> {
        let of_suspect = || self.suspects.first().map(Suspect::designer);
        let of_line = || self.link.line_errors.advice().map(str::to_owned);
        match self.verdict() {
            Verdict::Pass => None,
            Verdict::Fail => of_suspect().or_else(|| self.finding.remedy()),
            Verdict::Error => of_line().or_else(|| self.finding.remedy()),
        }
    }

    /// What a technician does with a board that is wrong, in one sentence: by the likeliest suspect, or else by the finding. None under
    /// PASS and ERROR.
    #[must_use]
    pub fn technician(&self) -> Option<String> {
        let of_suspect = || self.suspects.first().map(Suspect::technician);
        let is_wrong = self.verdict() == Verdict::Fail;
        is_wrong.then(|| of_suspect().or_else(|| self.finding.technician())).flatten()
    }

    /// Why there is no judgement; none under PASS and FAIL.
    #[must_use]
    pub fn error(&self) -> Option<Problem> {
        (self.verdict() == Verdict::Error)
            .then(|| Problem { remedy: self.remedy(), ..self.finding.as_problem() })
    }
}

/// What a report has behind what every document of the program begins with, with its sentences.
#[derive(Serialize)]
struct Rest<'a> {
    cause: Cause,
    headline: String,
    remedy: Option<String>,
    technician: Option<String>,
    finding: &'a Finding,
    suspects: &'a [Suspect],
    checks: &'a [Check],
    frames: &'a [FrameReport],
    not_exercised: Vec<InWords<'a>>,
    latency: &'a Option<LatencyReport>,
    street: &'a Option<StreetReport>,
    evidence: &'a EvidenceReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    soak: Option<&'a SoakReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    within: Option<&'a WithinReport>,
    coverage: Option<CoverageReport>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    lacks: &'a [Problem],
    link: &'a LinkReport,
    tables: &'a TablesReport,
    run: &'a RunReport,
}

impl<'a> From<&'a Report> for Rest<'a> {
    fn from(report: &'a Report) -> Self {
        Self {
            cause: report.cause,
            headline: report.headline(),
            remedy: report.remedy(),
            technician: report.technician(),
            finding: &report.finding,
            suspects: &report.suspects,
            checks: &report.checks,
            frames: &report.frames,
            not_exercised: report.not_exercised.iter().map(InWords::from).collect(),
            latency: &report.latency,
            street: &report.street,
            evidence: &report.evidence,
            soak: report.soak.as_ref(),
            within: report.within.as_ref(),
            coverage: report.coverage,
            lacks: &report.lacks,
            link: &report.link,
            tables: &report.tables,
            run: &report.run,
        }
    }
}

impl Serialize for Report {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Document {
            schema: self.schema,
            command: self.command(),
            verdict: Some(self.verdict()),
            exit_code: self.cause.into(),
            board: Some(&self.board),
            error: self.error().as_ref(),
            rest: Rest::from(self),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Report {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// The document has the verdict as well, which nobody may have written anew.
        #[derive(Deserialize)]
        struct Read {
            verdict: Verdict,
            #[serde(flatten, deserialize_with = "Report::deserialize")]
            report: Report,
        }
        let Read { verdict, report } = Read::deserialize(deserializer)?;
        if verdict == report.verdict() {
            return Ok(report);
        }
        let (cause, own) = (report.cause, report.verdict());
        Err(de::Error::custom(format!(
            "the verdict {verdict} is not that of the cause `{cause}`, {own}; take the report as it was written"
        )))
    }
}

/// Which board it was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoardReport {
    /// `mock`, `sim`, `replay` or `hardware`.
    pub kind: BoardKind,
    /// The target string.
    pub target: String,
    /// What the board says of itself; none when it never answered.
    pub identity: Option<Identity>,
}

impl BoardReport {
    /// Of a board that answers, behind a target of this kind.
    #[must_use]
    pub fn of(board: &Board, kind: BoardKind, target: String) -> Self {
        let kind = kind.confirmed_by(board.capabilities.nature);
        Self { kind, target, identity: Some(Identity::of(&board.welcome, &board.capabilities)) }
    }
}

/// Façade edges of the built-in street.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StreetReport {
    /// As the lens bends them.
    pub before: EdgeDeviation,
    /// As the board's correction leaves them.
    pub after: EdgeDeviation,
}

/// What was uploaded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Rows outside the image circle, which row factors do not stretch, and a grid not exactly; none when the tables are a file, which does not say.
    pub rows_outside_circle: Option<usize>,
    /// CRC-32 of the row factors or of the grid's entries, as on the wire. Earlier reports say `steps_crc32`.
    #[serde(alias = "steps_crc32")]
    pub tables_crc32: String,
    /// CRC-32 of the kernel's nodes, as on the wire.
    pub kernel_crc32: String,
}

/// The run itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// halfrow's version.
    pub version: String,
    /// The commit that it was built from.
    pub commit: String,
    /// The command line.
    pub arguments: Vec<String>,
    /// Seed of noise, gaps, the link test, the rules and what the board makes on its own. The session's numbers are drawn without it.
    pub seed: u64,
    /// When it began, RFC 3339, UTC.
    pub started: String,
    /// When it ended.
    pub ended: String,
    /// How long it took by the wall's clock, in seconds.
    pub seconds: f64,
    /// The host it ran on.
    pub host: String,
    /// Who tested, if anybody was named.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    /// Files that were read, with their SHA-256.
    pub files: Vec<FileHash>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FileHash {
    /// Its path, as given.
    pub path: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
}
