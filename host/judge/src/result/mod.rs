//! The result of a run as data: a [`Report`] that can be stored, read back and compared.
//!
//! ```text
//! Report ─► checks ─► Finding  ─┐
//!        ─► suspects ► Defect  ─┴─► wording ─► sentences, which the views print and the JSON carries
//! ```
//!
//! A finding is a code with parameters. Its sentence is made from them in [`wording`] and nowhere else. Reading a report back
//! takes the code and its parameters, never the sentence.

mod as_text;
mod asked;
mod bursts;
mod check;
pub mod codes;
mod counter;
pub(crate) mod counts_as_runs;
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
mod missing_rows;
mod not_exercised;
mod problem;
mod rule;
mod sha256;
mod soak;
mod suspect;
mod within;
pub mod wording;

use serde::{Deserialize, Deserializer, Serialize, de};

use crate::board::{Capabilities, Welcome};
use crate::frames::street::EdgeDeviation;
use crate::verdict::{Cause, Verdict};
use frames::WithTables;
use not_exercised::InWords;

pub use crate::target::BoardKind;
pub use asked::{Asked, Field};
pub use bursts::{BurstCount, ClockSeen, Corner, EqualAtSpeed, KeptRow, NoBurst, Repetition, Streamed};
pub use check::{Check, CheckName, Outcome};
pub use counter::Counter;
pub use coverage::CoverageReport;
pub use defect::{
    ClampEnd, ColumnParity, ContentKind, Counting, Defect, FlippedBit, Instead, KernelSwitch, LineFault,
    MadeAs, MadeWith, Memory, NamedBlanking, Reading, RowSource, SampleBus, SampleLines, StaleFrames,
    TableWord, TableWords,
};
pub use document::{Document, Schema};
pub use doubt::{BrokenOff, Doubt};
pub use evidence::{Evidence, EvidenceReport};
pub use extent::Extent;
pub use finding::Finding;
pub use frames::{FrameReport, FrameTiming, FrameTotals, LatencyReport, Variation};
pub use identity::{BurstsReport, GridsReport, Identity};
pub use late_rows::LateRows;
pub use link::{LinkReport, Reconnection};
pub use missing_rows::MissingRows;
pub use not_exercised::NotExercised;
pub(crate) use problem::asked_of_system;
pub use problem::{Parameters, Problem, split_remedy};
pub use rule::{Answer, MissingRow, NumberedRow, PlacedRow, RepeatedRow, RowPart, RowsTried, Rule};
pub(crate) use sha256::little_endian;
pub use sha256::sha256;
pub use soak::{SoakChart, SoakDifference, SoakInterval, SoakLength, SoakReport};
pub(crate) use suspect::CONVINCING;
pub(crate) use suspect::Lead;
pub use suspect::{Account, Shortfall, Suspect};
pub use within::{CoveragePoint, WithinPart, WithinReport};

/// A finished run of `verify` or `soak`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub struct Report {
    /// The version of its JSON's shape.
    pub schema: Schema,
    /// The board.
    pub board: BoardReport,
    /// Why the run ended as it did. The verdict follows from it.
    pub cause: Cause,
    /// The result.
    pub finding: Finding,
    /// The parts to which the pattern of differences points, the likeliest first.
    pub suspects: Vec<Suspect>,
    /// Every check, in the order of the run.
    pub checks: Vec<Check>,
    /// Every frame that was streamed, in order.
    pub frames: Vec<FrameReport>,
    /// What the run did not exercise of the board, under PASS; empty under FAIL and ERROR.
    #[serde(default)]
    pub not_exercised: Vec<NotExercised>,
    /// The latency of all rows.
    pub latency: Option<LatencyReport>,
    /// How straight the façade edges of the built-in street are, before and after correction.
    pub street: Option<StreetReport>,
    /// What was kept for diagnosis and pictures.
    pub evidence: EvidenceReport,
    /// Hours of frames at the full pixel clock; none unless the run was a soak.
    #[serde(default)]
    pub soak: Option<SoakReport>,
    /// What was taken of a run that had to keep within a time.
    #[serde(default)]
    pub within: Option<WithinReport>,
    /// What share of the Verilog's faults the run finds, under PASS; none when it was not measured.
    #[serde(default)]
    pub coverage: Option<CoverageReport>,
    /// What was asked for and could not be written; the verdict stands without it.
    #[serde(default)]
    pub lacks: Vec<Problem>,
    /// The link.
    pub link: LinkReport,
    /// What was uploaded.
    pub tables: TablesReport,
    /// The run itself, with enough to repeat it.
    pub run: RunReport,
}

impl Report {
    /// The verdict, which follows from the cause.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.cause.verdict()
    }

    /// The command that made the report.
    #[must_use]
    pub fn command(&self) -> &'static str {
        if self.soak.is_some() { "soak" } else { "verify" }
    }

    /// The result in one sentence.
    #[must_use]
    pub fn headline(&self) -> String {
        self.finding.sentence()
    }

    /// What to do next, if anything: as the likeliest suspect says, or else the finding. Under ERROR, errors on the line say it
    /// first if the finding may come from them.
    #[must_use]
    pub fn remedy(&self) -> Option<String> {
        let of_suspect = || self.suspects.first().map(Suspect::designer);
        let of_line = || self.link.line_advice_on(&self.finding).map(str::to_owned);
        match self.verdict() {
            Verdict::Pass => None,
            Verdict::Fail => of_suspect().or_else(|| self.finding.remedy()),
            Verdict::Error => of_line().or_else(|| self.finding.remedy()),
        }
    }

    /// What a technician should do with a board that is wrong: as the likeliest suspect says, or else the finding. None under
    /// PASS and ERROR.
    #[must_use]
    pub fn technician(&self) -> Option<String> {
        let of_suspect = || self.suspects.first().map(Suspect::technician);
        let is_wrong = self.verdict() == Verdict::Fail;
        is_wrong.then(|| of_suspect().or_else(|| self.finding.technician())).flatten()
    }

    /// Why the board could not be judged; none under PASS and FAIL.
    #[must_use]
    pub fn error(&self) -> Option<Problem> {
        (self.verdict() == Verdict::Error)
            .then(|| Problem { remedy: self.remedy(), ..self.finding.as_problem() })
    }
}

/// The keys of a report that follow those with which every document begins, with its sentences.
#[derive(Serialize)]
struct Rest<'a> {
    cause: Cause,
    headline: String,
    remedy: Option<String>,
    technician: Option<String>,
    finding: &'a Finding,
    suspects: &'a [Suspect],
    checks: &'a [Check],
    frames: Vec<WithTables<'a>>,
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
            frames: report.frames.iter().map(WithTables::from).collect(),
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
        /// The document also has the verdict, which must be that of the cause.
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

/// The board that was judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoardReport {
    /// `mock`, `sim`, `replay` or `hardware`.
    pub kind: BoardKind,
    /// The target string.
    pub target: String,
    /// What the board says about itself; none when it never answered.
    pub identity: Option<Identity>,
}

impl BoardReport {
    /// The report on a board that answers so at a `target` of this kind.
    #[must_use]
    pub fn of(welcome: &Welcome, capabilities: &Capabilities, kind: BoardKind, target: String) -> Self {
        let kind = kind.confirmed_by(capabilities.nature);
        Self { kind, target, identity: Some(Identity::of(welcome, capabilities)) }
    }
}

/// How straight the façade edges of the built-in street are.
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
    /// Where the tables came from: a file, or the lens and kernel in words.
    pub source: String,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Bits a sample.
    pub bits: u32,
    /// C, twice the optical centre's column.
    pub centre2: u32,
    /// Rows outside the image circle, which row factors do not stretch and a grid stretches only approximately; none for tables
    /// from a file, which does not say.
    pub rows_outside_circle: Option<usize>,
    /// CRC-32 of the row factors or of the grid's entries, as on the wire. Earlier reports call it `steps_crc32`.
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
    /// Seed of noise, gaps, the link test, the rules and the frames that the board makes itself. The session's numbers do not
    /// depend on it.
    pub seed: u64,
    /// When it began, RFC 3339, UTC.
    pub started: String,
    /// When it ended.
    pub ended: String,
    /// How long it took on the wall clock, in seconds.
    pub seconds: f64,
    /// The host it ran on.
    pub host: String,
    /// Who tested, if a name was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    /// The files that were read, with their SHA-256.
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
