//! From the options of a call to what a run does, and how.

use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

use halfrow::board::Stop;
use halfrow::board::deadlines::RetryLimit;
use halfrow::frames::{self, PictureSize, ReadOptions, UnknownBuiltin};
use halfrow::link::Recording;
use halfrow::model::{CorrectError, Frame, Geometry, Phase};
use halfrow::result::FileHash;
use halfrow::run::{Circumstances, Draws, RecordedRun, RunOptions, Vary};
use halfrow::{FrameSource, Plan};
use pyo3::prelude::*;

use crate::errors::Whose;
use crate::kernel::KernelLike;
use crate::tables::Tables;
use crate::{choices, errors, frames as files};

/// What stands before the name of a built-in frame.
const BUILTIN: &str = "builtin:";
/// How often frames can be streamed.
const REPEATS: RangeInclusive<u32> = 1..=1000;

/// The options of `verify`, as halfrow/_verify.py packs them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options<'py> {
    tables: Option<Bound<'py, Tables>>,
    kernel: Option<KernelLike<'py>>,
    frames: Vec<Bound<'py, PyAny>>,
    phase: String,
    repeat: u32,
    seed: u64,
    at_speed: Option<f64>,
    within: Option<f64>,
    fail_fast: bool,
    timeout: Option<f64>,
    reconnect: Option<f64>,
    retry_limit: Option<f64>,
    take_over: bool,
    require_hardware: bool,
    arguments: Vec<String>,
    pub(crate) report: Option<PathBuf>,
    pub(crate) record: Option<PathBuf>,
    pub(crate) overwrite: bool,
    pub(crate) progress: Option<Bound<'py, PyAny>>,
}

impl Options<'_> {
    /// What the run in `recording` did, if there is one, or else what the options say; it ends early by `stop`.
    pub(crate) fn planned(
        &mut self,
        recording: Option<&Recording>,
        stop: Stop,
    ) -> PyResult<(Plan, RunOptions)> {
        let timeout = choices::seconds("timeout", self.timeout)?;
        let stop = stop.within(timeout);
        let Some(recording) = recording else {
            let (plan, files) = self.plan()?;
            let options = RunOptions { timeout, stop, ..self.options(files)? };
            return Ok((plan, options));
        };
        let restored = RecordedRun::restore(recording);
        let (plan, options) =
            restored.map_err(|error| errors::raised(Whose::of_call(!error.is_other_datapath()), &error))?;
        Ok((plan, RunOptions { require_hardware: self.require_hardware, stop, ..options }))
    }

    fn plan(&mut self) -> PyResult<(Plan, Vec<FileHash>)> {
        if self.within.is_some() && !(self.frames.is_empty() && self.record.is_none()) {
            return Err(errors::conflict(
                "within chooses the frames and is of one link; leave out frames and record",
            ));
        }
        if self.reconnect.is_some() && self.record.is_some() {
            return Err(errors::conflict("a recording is of one link; leave out reconnect or record"));
        }
        if !REPEATS.contains(&self.repeat) {
            return Err(errors::wrong_value(format!(
                "frames cannot be repeated {} times; give 1 to 1000",
                self.repeat
            )));
        }
        let phase = choices::phase(&self.phase)?;
        let is_free = self.tables.is_none() && self.frames.is_empty();
        let (plan, mut files) = self.of_tables(phase)?;
        let named = std::mem::take(&mut self.frames);
        let geometry = plan.tables.geometry();
        let taken =
            named.iter().enumerate().map(|(place, frame)| source(frame, place, phase, geometry, &mut files));
        let sources = taken.collect::<PyResult<Vec<_>>>()?;
        let frames = if sources.is_empty() { plan.frames.clone() } else { sources };
        let plan = Plan {
            frames,
            repeat: self.repeat,
            vary: Vary { centre: is_free, depth: is_free },
            at_speed: choices::seconds("at_speed", self.at_speed)?,
            within: choices::seconds("within", self.within)?,
            fail_fast: self.fail_fast,
            seed: self.seed,
            ..plan
        };
        plan.check_length().map_err(errors::input)?;
        Ok((plan, files))
    }

    /// To judge with the tables of the call, or else with those of the paper's lens, and the files that they came from.
    fn of_tables(&mut self, phase: Phase) -> PyResult<(Plan, Vec<FileHash>)> {
        let own;
        let tables = match &self.tables {
            Some(tables) => tables.get(),
            None => {
                own = Tables::of_paper()?;
                &own
            }
        };
        let mut chosen = tables.chosen.clone();
        if let Some(kernel) = self.kernel.take() {
            let (kernel, name) = kernel.taken()?;
            chosen.kernel = kernel;
            chosen.source = format!("{}, judged with the {name} kernel", chosen.source);
        }
        Ok((chosen.plan(phase), tables.files.clone()))
    }

    fn options(&mut self, files: Vec<FileHash>) -> PyResult<RunOptions> {
        let mut retry_limit = RetryLimit::default();
        if let Some(percent) = self.retry_limit {
            if !(0.0..=100.0).contains(&percent) {
                return Err(errors::wrong_value("retry_limit is no percentage; give 0 to 100"));
            }
            retry_limit.share = percent / 100.0;
        }
        let arguments = std::mem::take(&mut self.arguments);
        Ok(RunOptions {
            retry_limit,
            reconnect: choices::seconds("reconnect", self.reconnect)?,
            take_over: self.take_over,
            require_hardware: self.require_hardware,
            keep_equal: self.report.is_some(),
            circumstances: Circumstances { arguments, files, draws: Draws::draw(), operator: None },
            ..RunOptions::default()
        })
    }
}

/// Frame `place` of a call: an array, `builtin:NAME` or a file, whose hash joins `files`.
fn source(
    given: &Bound<'_, PyAny>,
    place: usize,
    phase: Phase,
    geometry: &Geometry,
    files: &mut Vec<FileHash>,
) -> PyResult<FrameSource> {
    if let Ok(name) = given.extract::<String>()
        && let Some(name) = name.strip_prefix(BUILTIN)
    {
        return Ok(FrameSource::Builtin(name.parse().map_err(errors::input::<UnknownBuiltin>)?));
    }
    let depth = geometry.depth();
    let (path, frame) = if let Ok(path) = given.extract::<PathBuf>() {
        let size = PictureSize::Exactly(geometry.width(), geometry.height());
        let how = ReadOptions { depth, phase, size, ..ReadOptions::default() };
        let read = given.py().detach(|| frames::read(&path, &how)).map_err(errors::input)?;
        files.push(files::hash(&path)?);
        (path, read)
    } else {
        let name = format!("frames[{place}]");
        let frame = files::frame_of(given, &name, depth.bits(), phase.name())?;
        (name.into(), frame)
    };
    check_size(&frame, geometry)?;
    Ok(FrameSource::File { path, frame: Arc::new(frame) })
}

fn check_size(frame: &Frame, geometry: &Geometry) -> PyResult<()> {
    let (frame_width, frame_height) = (frame.width(), frame.height());
    let (width, height) = (geometry.width(), geometry.height());
    if (frame_width, frame_height) == (width, height) {
        return Ok(());
    }
    Err(errors::input(CorrectError::Size { frame_width, frame_height, width, height }))
}
