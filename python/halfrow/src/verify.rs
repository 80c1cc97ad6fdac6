//! Judging a board.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfrow::board::Stop;
use halfrow::call::Files;
use halfrow::link::{self, Class, OpenError, Recording, RecordingFile};
use halfrow::result::Problem;
use halfrow::run::{self, Misfit, RecordedRun};
use halfrow::target::{Target, TargetError};
use halfrow::verdict::Cause;
use halfrow::{Finished, Plan, ReportFolder, RunOptions, StoppedBy};
use pyo3::exceptions::PyBaseException;
use pyo3::prelude::*;

use crate::arguments;
use crate::errors::{self, Whose};
use crate::plan::{Options, Planned};
use crate::run::Run;
use crate::watched::watched;

/// Judges the board at the target `board`; halfrow/_verify.py documents the options. The second value is the exception that says
/// why the run never began, if it did not.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    #[pyo3(from_py_with = arguments::board)] board: String,
    options: &Bound<'_, PyAny>,
) -> PyResult<(Run, Option<Py<PyBaseException>>)> {
    let mut asked: Options<'_> = options.extract().map_err(|error| errors::not_taken(py, &error))?;
    let target: Target = board.parse().map_err(errors::input::<TargetError>)?;
    let recording = py.detach(|| link::recording(&target)).map_err(not_opened)?;
    let is_stopped = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&is_stopped);
    let stop = Stop::when(move || stopped.load(Ordering::Relaxed).then_some(StoppedBy::Person));
    let Planned { plan, options, inputs, kernel } = asked.planned(py, recording.as_ref(), stop)?;
    let files = Files::new(asked.overwrite)
        .reads(inputs)
        .reads_kernel(kernel.as_deref().map(Path::as_os_str))
        .reads(link::recording_file(&target))
        .writes_claimed(link::WRITTEN_FILE, link::written_file(&target))
        .writes_claimed("record", asked.record.as_deref())
        .writes_report("report", asked.report.as_deref());
    files.check().map_err(errors::input)?;
    // There is no need to report recordings that are kept: their names say what they are.
    _ = files.clear_leftovers();
    let report = asked.report.as_deref().map(|path| ReportFolder::prepare(path, asked.overwrite));
    let report = report.transpose().map_err(errors::input)?;
    let record = asked.record.as_deref().map(|path| RecordingFile::prepare(path, asked.overwrite));
    let record = record.transpose().map_err(errors::input)?;
    let job = Job { plan, options, target, recording, record, report };
    let done = watched(py, asked.progress.as_ref(), Some(&is_stopped), move |progress| job.run(progress))?;
    let Done { finished, not_begun } = done.map_err(|error| errors::refused(error.as_ref()))?;
    let raised = not_begun.map(|error| errors::raised(Whose::World, error.as_ref()).into_value(py));
    Ok((Run { finished }, raised))
}

fn not_opened(error: OpenError) -> PyErr {
    errors::raised(Whose::of_call(error.class() == Class::Call), &error)
}

/// Everything that a run needs.
struct Job {
    plan: Plan,
    options: RunOptions,
    target: Target,
    recording: Option<Recording>,
    record: Option<RecordingFile>,
    report: Option<ReportFolder>,
}

/// What a job came to.
struct Done {
    finished: Finished,
    /// Why the run never began, if it did not. The report says the same.
    not_begun: Option<Reason>,
}

type Reason = Box<dyn Error + Send + Sync>;

/// Why a run never began.
struct NotBegun {
    /// The class of the reason; none if the call is to blame.
    cause: Option<Cause>,
    reason: Reason,
}

impl From<OpenError> for NotBegun {
    fn from(error: OpenError) -> Self {
        let class = error.class();
        Self { cause: (class != Class::Call).then(|| class.into()), reason: error.into() }
    }
}

impl From<Misfit> for NotBegun {
    fn from(misfit: Misfit) -> Self {
        Self { cause: misfit.is_other_datapath().then_some(Cause::Refused), reason: misfit.into() }
    }
}

impl Job {
    /// Judges the board and writes the report, also that of a run that never began. A wrong call is no run and has none.
    fn run(mut self, progress: &dyn halfrow::Progress) -> Result<Done, Reason> {
        let (mut finished, not_begun) = match self.judge(progress) {
            Ok(finished) => (finished, None),
            Err(NotBegun { cause: None, reason }) => return Err(reason),
            Err(NotBegun { cause: Some(cause), reason }) => {
                let problem = Problem::of(reason.as_ref());
                (run::not_begun(&self.plan, &self.target, cause, problem, &self.options), Some(reason))
            }
        };
        // A lost recording or report does not raise: the report says what is missing, and a PASS without its evidence is no PASS.
        if let Some(folder) = self.report {
            _ = finished.commit(folder);
        }
        Ok(Done { finished, not_begun })
    }

    fn judge(&mut self, progress: &dyn halfrow::Progress) -> Result<Finished, NotBegun> {
        let candidate = match self.recording.take() {
            None => link::open(&self.target)?,
            Some(recording) => link::replay(&self.target, recording)?,
        };
        let begun = RecordedRun::begin(&self.plan, &self.options, candidate, self.record.take());
        let (candidate, lost) =
            begun.map_err(|error| NotBegun { cause: Some(Cause::Station), reason: error.into() })?;
        let mut finished = run::verify(&self.plan, candidate, &self.options, progress)?;
        finished.note_recording(&lost);
        Ok(finished)
    }
}
