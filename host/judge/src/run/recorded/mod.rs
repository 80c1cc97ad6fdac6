//! What a recording says about its run, so that the same conversation can be held again. The frames come from the rows
//! that were sent, since their files may be elsewhere.

mod sent;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use halfrow_model::{Equidistant, Frame, FrameError, Geometry, LensError, Phase, UnknownPhase};
use serde::{Deserialize, Serialize};

use super::{AtSpeed, FrameSource, JUDGED, Plan, Provenance, RunOptions, Selection, SessionIds, Vary};
use crate::board::RetryLimit;
use crate::frames::{Builtin, UnknownBuiltin};
use crate::link::{Candidate, LinkError, Lost, Recorder, Recording, RecordingError, RecordingFile};
use crate::tables::{ContentError, TableFile};
use sent::Sent;

/// The plan of a recorded run.
#[derive(Debug, Serialize, Deserialize)]
pub struct RecordedRun {
    version: String,
    arguments: Vec<String>,
    #[serde(rename = "draws")]
    session_ids: SessionIds,
    tables: String,
    tables_source: String,
    rows_outside_circle: Option<usize>,
    lens_radius: f64,
    /// A recording without this key is of a lens that images 90 degrees at `lens_radius`.
    lens_focal_length: Option<f64>,
    centre_y: Option<f64>,
    phase: String,
    frames: Vec<String>,
    repeat: u32,
    /// A recording without this key holds no such frames.
    #[serde(default)]
    vary: Vary,
    /// A recording without this key has all of them.
    #[serde(default)]
    parts: Option<Selection>,
    /// A recording without this key holds no such frames.
    #[serde(default = "none_at_speed")]
    at_speed: Option<Duration>,
    fail_fast: bool,
    take_over: bool,
    /// A recording without this key holds no such requests.
    #[serde(default)]
    counts: bool,
    seed: u64,
    timeout: Option<Duration>,
    retries: u64,
    retry_share: f64,
}

/// A recording whose run cannot be made again.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// Its head cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The tables in the recording cannot be used.
    #[error("the tables in the recording cannot be used; make the recording again")]
    Tables(#[source] ContentError),
    /// The recording begins with the description of a run that cannot be, as with a frame or lens that this program does not
    /// know.
    #[error(
        "the recording's head describes a run that cannot be; make the recording again with this halfrow"
    )]
    Value(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// What the recorded run sent as a frame does not have the size and depth of its tables.
    #[error(
        "the recorded run sent {name}, which is not a frame of its tables' size and depth; make the recording again"
    )]
    Frame {
        /// The frame.
        name: String,
        /// Why.
        #[source]
        source: FrameError,
    },
}

impl RestoreError {
    /// Whether the recording is of another datapath, so that it is refused like a board of one.
    #[must_use]
    pub fn is_other_datapath(&self) -> bool {
        matches!(self, Self::Tables(ContentError::Datapath(_)))
    }
}

impl RecordedRun {
    /// `candidate`, its link recorded in `file` as that of a run by `plan`, and where a loss of the recording will be reported.
    /// Without a file nothing is recorded.
    ///
    /// # Errors
    /// [`LinkError::Record`] when the file cannot be written.
    pub fn begin(
        plan: &Plan,
        options: &RunOptions,
        candidate: Candidate,
        file: Option<RecordingFile>,
    ) -> Result<(Candidate, Lost), LinkError> {
        let Some(file) = file else { return Ok((candidate, Lost::default())) };
        let link = Recorder::begin(candidate.link, file, &Self::of(plan, options))?;
        let lost = link.lost();
        Ok((Candidate { link: Box::new(link), ..candidate }, lost))
    }

    fn of(plan: &Plan, options: &RunOptions) -> Self {
        let file = TableFile { tables: plan.tables.clone(), kernel: plan.kernel.clone(), about: None };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            arguments: options.provenance.arguments.clone(),
            session_ids: options.provenance.session_ids,
            tables: file.to_json(),
            tables_source: plan.tables_source.clone(),
            rows_outside_circle: plan.rows_outside_circle,
            lens_radius: plan.lens.radius(),
            lens_focal_length: Some(plan.lens.focal_length()),
            centre_y: plan.centre_y,
            phase: plan.phase.to_string(),
            frames: plan.frames.iter().map(FrameSource::name).collect(),
            repeat: plan.repeat,
            vary: plan.vary,
            parts: plan.selection.clone(),
            at_speed: match plan.at_speed {
                AtSpeed::Usual | AtSpeed::Soak(_) => None,
                AtSpeed::Off => none_at_speed(),
                AtSpeed::For(time) => Some(time),
            },
            fail_fast: plan.fail_fast,
            take_over: options.take_over,
            counts: options.counts,
            seed: plan.seed,
            timeout: options.timeout,
            retries: options.retry_limit.fixed,
            retry_share: options.retry_limit.share,
        }
    }

    /// The plan and the options of the run that `recording` holds. The files that the run read are not named; all its
    /// frames are kept for pictures, as far as there is room.
    ///
    /// # Errors
    /// [`RestoreError`] when the recording does not hold what this needs.
    pub fn restore(recording: &Recording) -> Result<(Plan, RunOptions), RestoreError> {
        let run: Self = recording.run()?;
        let file = TableFile::parse(&run.tables).map_err(RestoreError::Tables)?;
        let phase = run.phase.parse().map_err(value::<UnknownPhase>)?;
        let plan = Plan {
            tables_source: run.tables_source.clone(),
            rows_outside_circle: run.rows_outside_circle,
            lens: run.lens().map_err(value)?,
            centre_y: run.centre_y,
            phase,
            repeat: run.repeat,
            vary: run.vary,
            selection: run.parts.clone(),
            at_speed: run.at_speed.into(),
            fail_fast: run.fail_fast,
            seed: run.seed,
            frames: run.frames(recording, file.tables.geometry(), phase)?,
            ..Plan::new(file.tables, file.kernel)
        };
        let options = RunOptions {
            timeout: run.timeout,
            retry_limit: RetryLimit { fixed: run.retries, share: run.retry_share },
            take_over: run.take_over,
            counts: run.counts,
            keep_equal: true,
            provenance: Provenance {
                arguments: run.arguments,
                session_ids: run.session_ids,
                ..Provenance::default()
            },
            ..RunOptions::default()
        };
        Ok((plan, options))
    }

    fn lens(&self) -> Result<Equidistant, LensError> {
        match self.lens_focal_length {
            Some(focal_length) => Equidistant::from_both(focal_length, self.lens_radius),
            None => Equidistant::from_radius(self.lens_radius),
        }
    }

    fn frames(
        &self,
        recording: &Recording,
        geometry: &Geometry,
        phase: Phase,
    ) -> Result<Vec<FrameSource>, RestoreError> {
        let commits = Sent::find(recording.sent(), |_| false);
        let first = commits.first_frames.get(&JUDGED).copied().unwrap_or_default();
        let numbered = self.frames.iter().enumerate();
        let numbered = numbered.map(|(index, name)| (name, first.wrapping_add(index as u16)));
        let is_file = |(name, _): &(&String, u16)| !name.starts_with(Builtin::PREFIX);
        let files: BTreeSet<u16> = numbered.clone().filter(is_file).map(|(_, number)| number).collect();
        let sent = Sent::find(recording.sent(), |number| files.contains(&number));
        numbered
            .map(|(name, number)| {
                if let Some(builtin) = Builtin::named(name).map_err(value::<UnknownBuiltin>)? {
                    return Ok(FrameSource::Builtin(builtin));
                }
                let samples = sent.frame(number, geometry.width(), geometry.height());
                let frame = Frame::new(geometry.width(), geometry.depth(), phase, samples)
                    .map_err(|source| RestoreError::Frame { name: name.clone(), source })?;
                Ok(FrameSource::File { path: PathBuf::from(name), frame: Arc::new(frame) })
            })
            .collect()
    }
}

fn none_at_speed() -> Option<Duration> {
    Some(Duration::ZERO)
}

fn value<E: std::error::Error + Send + Sync + 'static>(error: E) -> RestoreError {
    RestoreError::Value(Box::new(error))
}
