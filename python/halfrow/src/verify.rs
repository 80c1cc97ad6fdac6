//! Judging a board.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfrow::board::Stop;
use halfrow::call::Files;
use halfrow::link::{self, Candidate, Class, Lost, OpenError, Recorder, RecordingFile};
use halfrow::run::{self, RecordedRun};
use halfrow::target::{Target, TargetError};
use halfrow::{Finished, Plan, ReportFolder, RunOptions, StoppedBy};
use pyo3::prelude::*;

use crate::arguments;
use crate::errors::{self, Whose};
use crate::plan::{Options, Planned};
use crate::run::Run;
use crate::watched::watched;

/// Judges the board at the target `board`; halfrow/_verify.py documents the options.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    #[pyo3(from_py_with = arguments::board)] board: String,
    options: &Bound<'_, PyAny>,
) -> PyResult<Run> {
    let mut asked: Options<'_> = options.extract().map_err(|error| errors::not_taken(py, &error))?;
    let target: Target = board.parse().map_err(errors::input::<TargetError>)?;
    let recording = py.detach(|| link::recording(&target)).map_err(not_opened)?;
    let is_stopped = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&is_stopped);
    let stop = Stop::when(move || stopped.load(Ordering::Relaxed).then_some(StoppedBy::Person));
    let Planned { plan, options, inputs, kernel } = asked.planned(recording.as_ref(), stop)?;
    let files = Files::new(asked.overwrite)
        .reads(inputs)
        .reads_kernel(kernel.as_deref().map(Path::as_os_str))
        .reads(link::recording_file(&target))
        .writes_claimed("record", asked.record.as_deref())
        .writes_report("report", asked.report.as_deref());
    files.check().map_err(errors::input)?;
    // There is no need to report recordings that are kept: their names say what they are.
    _ = files.clear_leftovers();
    let report = asked.report.as_deref().map(|path| ReportFolder::prepare(path, asked.overwrite));
    let report = report.transpose().map_err(errors::input)?;
    let record = asked.record.as_deref().map(|path| RecordingFile::prepare(path, asked.overwrite));
    let record = record.transpose().map_err(errors::input)?;
    let candidate = match recording {
        None => py.detach(|| link::open(&target)),
        Some(recording) => link::replay(&target, recording),
    };
    let job = Job { plan, options, candidate: candidate.map_err(not_opened)?, record, report };
    let done = watched(py, asked.progress.as_ref(), &is_stopped, move |progress| job.run(progress))?;
    Ok(Run { finished: done.map_err(|NotRun { whose, error }| errors::raised(whose, error.as_ref()))? })
}

fn not_opened(error: OpenError) -> PyErr {
    errors::raised(Whose::of_call(error.class() == Class::Call), &error)
}

/// Everything that a run needs.
struct Job {
    plan: Plan,
    options: RunOptions,
    candidate: Candidate,
    record: Option<RecordingFile>,
    report: Option<ReportFolder>,
}

/// Why there is no run to report on.
struct NotRun {
    whose: Whose,
    error: Box<dyn std::error::Error + Send + Sync>,
}

impl Job {
    fn run(self, progress: &dyn halfrow::Progress) -> Result<Finished, NotRun> {
        let mut candidate = self.candidate;
        let mut lost = Lost::default();
        if let Some(file) = self.record {
            let link = Recorder::begin(candidate.link, file, &RecordedRun::of(&self.plan, &self.options))
                .map_err(|error| NotRun { whose: Whose::World, error: error.into() })?;
            lost = link.lost();
            candidate = Candidate { link: Box::new(link), ..candidate };
        }
        let mut finished = run::verify(&self.plan, candidate, &self.options, progress).map_err(|error| {
            NotRun { whose: Whose::of_call(!error.is_other_datapath()), error: error.into() }
        })?;
        // A lost recording or report does not raise: the report says what is missing, and a PASS without its evidence is no PASS.
        if let Some(error) = lost.get() {
            finished.lose_recording(error);
        }
        if let Some(folder) = self.report {
            _ = finished.commit(folder);
        }
        Ok(finished)
    }
}
