//! Why a command has no result, and who is to blame for it: the exit code that each error leads to.

use crate::commands::codes;
use crate::exit::Exit;
use crate::{flags, json};
use halfrow::board::{BoardError, OpenFailed};
use halfrow::call::VoidOption;
use halfrow::correction::CorrectionError;
use halfrow::link::OpenError;
use halfrow::optics::OpticsError;
use halfrow::result::{Document, Problem, Schema};
use halfrow::run::{Misfit, RestoreError, WithinError};
use halfrow_lab::paper::PaperError;
use serde_json::Value;

/// Why a command has no result.
#[derive(Debug)]
pub struct Failure {
    /// The exit code.
    pub exit: Exit,
    /// Why, with its causes.
    pub error: anyhow::Error,
    /// The option whose value is wrong, as written on the command line, if that is known.
    pub(crate) option: Option<&'static str>,
    /// The keys of its document in addition to those of any other failure: what the command found nevertheless.
    pub(crate) so_far: Option<Value>,
    /// Whether the call is refused, so that what its error asks for does not fit if the system alone is the cause.
    pub(crate) is_refusal: bool,
}

impl Failure {
    /// A failure of the call or of its input, unless the system alone is its cause.
    pub(crate) fn call(error: impl Into<anyhow::Error>) -> Self {
        let error = error.into();
        Self { is_refusal: true, ..Self::of(Exit::of_refusal(error.as_ref()), error) }
    }

    /// A failure for which the call is not to blame.
    pub fn error(error: impl Into<anyhow::Error>) -> Self {
        Self::of(Exit::Error, error)
    }

    /// An input that is refused, like a board of another datapath.
    pub(crate) fn refused(error: impl Into<anyhow::Error>) -> Self {
        Self::of(Exit::Refused, error)
    }

    /// A failure with this exit code.
    pub(crate) fn of(exit: Exit, error: impl Into<anyhow::Error>) -> Self {
        Self { exit, error: error.into(), option: None, so_far: None, is_refusal: false }
    }

    /// This failure, attributed to the value of `option`, wherever that comes from.
    pub(crate) fn in_value_of(self, option: &'static str) -> Self {
        Self { option: Some(option), ..self }
    }

    /// Why, in words that name the flags of this program.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let problem = codes::problem(self.exit, &self.error);
        let is_refusal = self.is_refusal;
        flags::named_in(if is_refusal { problem.of_refusal(self.error.as_ref()) } else { problem })
    }

    /// The document of `command`, which failed with this.
    #[must_use]
    pub fn document(&self, command: &str) -> String {
        let (problem, rest) = (self.problem(), &self.so_far);
        let (verdict, error) = (self.exit.verdict(), Some(&problem));
        let failed =
            Document { schema: Schema, command, verdict, exit_code: self.exit, board: None, error, rest };
        json::document(&failed).unwrap_or_default()
    }
}

impl From<VoidOption> for Failure {
    fn from(error: VoidOption) -> Self {
        Self::call(error)
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        Self::of(error.class().into(), error)
    }
}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        Self::of(error.cause().into(), error)
    }
}

impl From<OpenFailed> for Failure {
    fn from(failed: OpenFailed) -> Self {
        failed.error.into()
    }
}

impl From<Misfit> for Failure {
    fn from(error: Misfit) -> Self {
        let option = match &error {
            Misfit::Taps => Some("--kernel"),
            Misfit::Within(WithinError::AtSpeed { .. }) => Some("--at-speed"),
            _ => None,
        };
        let failure = if error.is_other_datapath() { Self::refused(error) } else { Self::call(error) };
        Self { option, ..failure }
    }
}

impl From<CorrectionError> for Failure {
    fn from(error: CorrectionError) -> Self {
        match error {
            CorrectionError::Misfit(misfit) => misfit.into(),
            CorrectionError::Frame(unfit) => Self::call(unfit),
            CorrectionError::Board(error) => error.into(),
        }
    }
}

/// A file of another datapath is refused like a board of another datapath.
impl From<OpticsError> for Failure {
    fn from(error: OpticsError) -> Self {
        match error {
            OpticsError::Damaged(_) => Self::error(error),
            error if error.is_other_datapath() => Self::refused(error),
            error => Self::call(error),
        }
    }
}

impl From<RestoreError> for Failure {
    fn from(error: RestoreError) -> Self {
        if error.is_other_datapath() { Self::refused(error) } else { Self::call(error) }
    }
}

impl From<PaperError> for Failure {
    fn from(error: PaperError) -> Self {
        match &error {
            PaperError::Board(of_board) => Self::of(of_board.cause().into(), error),
            PaperError::Misfit(misfit) if misfit.is_other_datapath() => Self::refused(error),
            PaperError::Misfit(_) | PaperError::Synthesis { .. } => Self::call(error),
            _ => Self::error(error),
        }
    }
}
