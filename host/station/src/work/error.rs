//! Why a job came to no run.

use halfrow::target::TargetError;

use crate::run::RunError;
use crate::store::AgainError;

/// A job that came to no run.
#[derive(Debug, thiserror::Error)]
pub enum WorkError {
    /// The run has no verdict.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The unit passed already, and the plan does not let it be judged again.
    #[error(transparent)]
    Again(#[from] AgainError),
    /// The station lacks the plan of a job, although it said that it has it.
    #[error("this station does not have the plan {sha256} of the job {job}; report this with the version")]
    NoPlan {
        /// The job.
        job: String,
        /// The plan's hash.
        sha256: String,
    },
    /// The board's place at the plant is not a target that this program can open.
    #[error("the plant says that the board {board} is at {target}, which is no board; share it anew")]
    Target {
        /// The board.
        board: String,
        /// Where it is said to be.
        target: String,
        /// Why that is none.
        source: TargetError,
    },
    /// The board is shared as a unit that the plan of the job does not judge.
    #[error(
        "the board {board} is shared under the serial number `{serial}`, which is none of the plan {plan}; share it under the one on its \
         label, or not at all, by `halfrow-station board unshare {board}`"
    )]
    Serial {
        /// The board.
        board: String,
        /// Its serial number, as it is shared.
        serial: String,
        /// The plan's product and name.
        plan: String,
    },
    /// The plant was reached, but refused the run of a job.
    #[error(
        "the plant does not take the run {run}, which is kept here: {said}; `halfrow-station outbox list` shows its \
         state"
    )]
    NotTaken {
        /// The run.
        run: String,
        /// What it said.
        said: String,
    },
}

impl WorkError {
    /// Whether the board was not touched, for a reason that lies with the station and not with the job.
    pub(super) const fn is_not_begun(&self) -> bool {
        matches!(self, Self::Run(RunError::NotBegun(_) | RunError::NoRandomness(_) | RunError::PlanFile(_)))
    }

    /// Whether the board cannot be judged as it is shared. It was not touched.
    pub(super) const fn is_of_board(&self) -> bool {
        matches!(self, Self::Target { .. } | Self::Serial { .. })
    }

    /// Whether a file of the job's plan was changed. The log has said so, and jobs of other plans may get further.
    pub(crate) const fn is_of_plan(&self) -> bool {
        matches!(self, Self::Run(RunError::PlanFile(_)))
    }

    /// Whether the station's own store fails, or the plant where it had to be asked first, so that another job would get no
    /// further.
    #[must_use]
    pub(crate) const fn is_of_store(&self) -> bool {
        matches!(
            self,
            Self::Run(RunError::NotBegun(_) | RunError::NoRandomness(_) | RunError::Unsaved { .. })
        )
    }
}
