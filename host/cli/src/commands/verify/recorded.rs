//! What a recording says of its run, so that the same conversation can be held again: the frames come from the rows
//! that were sent, since their files may be elsewhere.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use halfrow_model::{Equidistant, Frame, Geometry, Phase};
use serde::{Deserialize, Serialize};

use super::Failure;
use halfrow::board::Sent;
use halfrow::board::deadlines::RetryLimit;
use halfrow::link::Recording;
use halfrow::run::{Circumstances, Draws, FrameSource, JUDGED, Plan};
use halfrow::tables::{ContentError, TableFile};
use halfrow::verdict::Exit;

/// The plan of a recorded run.
#[derive(Serialize, Deserialize)]
pub(super) struct RecordedRun {
    version: String,
    arguments: Vec<String>,
    draws: Draws,
    tables: String,
    tables_source: String,
    rows_outside_circle: Option<usize>,
    lens_radius: f64,
    centre_y: Option<f64>,
    phase: String,
    frames: Vec<String>,
    repeat: u32,
    fail_fast: bool,
    take_over: bool,
    seed: u64,
    timeout: Option<Duration>,
    retries: u64,
    retry_share: f64,
}

impl RecordedRun {
    pub(super) fn of(plan: &Plan, circumstances: &Circumstances) -> Self {
        let file = TableFile { tables: plan.tables.clone(), kernel: plan.kernel.clone(), about: None };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            arguments: circumstances.arguments.clone(),
            draws: circumstances.draws,
            tables: file.to_json(),
            tables_source: plan.tables_source.clone(),
            rows_outside_circle: plan.rows_outside_circle,
            lens_radius: plan.lens.radius(),
            centre_y: plan.centre_y,
            phase: plan.phase.to_string(),
            frames: plan.frames.iter().map(FrameSource::name).collect(),
            repeat: plan.repeat,
            fail_fast: plan.fail_fast,
            take_over: plan.take_over,
            seed: plan.seed,
            timeout: plan.timeout,
            retries: plan.retry_limit.fixed,
            retry_share: plan.retry_limit.share,
        }
    }
}

/// The plan and the circumstances of the run that `recording` holds. Whether hardware is required and pictures are kept is
/// for the present call to say.
pub(super) fn restore(
    recording: &Recording,
    require_hardware: bool,
    keep_pictures: bool,
) -> Result<(Plan, Circumstances), Failure> {
    let run: RecordedRun = recording.run()?;
    let file = TableFile::parse(&run.tables).map_err(|error| Failure {
        exit: if matches!(error, ContentError::Datapath(_)) { Exit::Refused } else { Exit::Usage },
        error: error.into(),
    })?;
    let phase = run.phase.parse()?;
    let plan = Plan {
        frames: frames(&run, recording, file.tables.geometry(), phase)?,
        tables: file.tables,
        kernel: file.kernel,
        tables_source: run.tables_source,
        rows_outside_circle: run.rows_outside_circle,
        lens: Equidistant::from_radius(run.lens_radius)?,
        centre_y: run.centre_y,
        phase,
        repeat: run.repeat,
        fail_fast: run.fail_fast,
        require_hardware,
        take_over: run.take_over,
        seed: run.seed,
        timeout: run.timeout,
        retry_limit: RetryLimit { fixed: run.retries, share: run.retry_share },
        reconnect: None,
        keep_pictures,
    };
    let circumstances = Circumstances { arguments: run.arguments, files: Vec::new(), draws: run.draws };
    Ok((plan, circumstances))
}

fn frames(
    run: &RecordedRun,
    recording: &Recording,
    geometry: &Geometry,
    phase: Phase,
) -> anyhow::Result<Vec<FrameSource>> {
    let is_file = |name: &&String| !name.starts_with("builtin:");
    let files: Vec<u16> =
        (0..).zip(&run.frames).filter(|(_, name)| is_file(name)).map(|(index, _)| index).collect();
    let commits = Sent::find(recording.sent(), |_| false);
    let first = commits.first_frames.get(&JUDGED).copied().unwrap_or_default();
    let is_of_file = |number: u16| number.checked_sub(first).is_some_and(|index| files.contains(&index));
    let sent = Sent::find(recording.sent(), is_of_file);
    let sources = run.frames.iter().zip(first..);
    sources
        .map(|(name, number)| {
            if let Some(builtin) = name.strip_prefix("builtin:") {
                return Ok(FrameSource::Builtin(builtin.parse()?));
            }
            let samples = sent.frame(number, geometry.width(), geometry.height());
            let frame = Frame::new(geometry.width(), geometry.depth(), phase, samples)?;
            Ok(FrameSource::File { path: PathBuf::from(name), frame: Arc::new(frame) })
        })
        .collect()
}
