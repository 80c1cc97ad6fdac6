//! From the options of a call to the plan and options of a run.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use halfrow::board::{RetryLimit, Stop};
use halfrow::call::{self, Input, Voided};
use halfrow::frames::{Builtin, FrameFile, PictureSize, ReadError, ReadOptions};
use halfrow::link::Recording;
use halfrow::model::{Frame, Geometry, Phase};
use halfrow::result::FileHash;
use halfrow::run::{Provenance, RecordedRun, RunOptions, SessionIds, Vary};
use halfrow::{FrameSource, Plan};
use pyo3::prelude::*;

use crate::errors::Whose;
use crate::kernel::Kernel;
use crate::tables::Tables;
use crate::{arguments, choices, errors, frames};

/// The options of `verify`, as halfrow/_verify.py packs them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options<'py> {
    tables: Option<Bound<'py, Tables>>,
    kernel: Bound<'py, PyAny>,
    frames: Option<Vec<Bound<'py, PyAny>>>,
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
    /// The names of the options whose value is not the default.
    given: Vec<String>,
}

/// What is judged and how, and the files that this is read from.
pub(crate) struct Planned {
    pub(crate) plan: Plan,
    pub(crate) options: RunOptions,
    /// The files of tables, lens and frames.
    pub(crate) inputs: Vec<PathBuf>,
    /// The name or file of the kernel, unless it is the tables' own.
    pub(crate) kernel: Option<PathBuf>,
}

/// A plan, the files that it was read from, and the name or file of its kernel.
struct LoadedPlan {
    plan: Plan,
    files: Vec<Input>,
    kernel: Option<PathBuf>,
}

impl Options<'_> {
    /// The run in `recording`, if there is one, else the run that the options describe. `stop` ends it early.
    pub(crate) fn planned(
        &mut self,
        py: Python<'_>,
        recording: Option<&Recording>,
        stop: Stop,
    ) -> PyResult<Planned> {
        if let Some(progress) = &self.progress {
            arguments::check_progress(progress)?;
        }
        let timeout = choices::time_limit("timeout", self.timeout)?;
        let stop = stop.wall_limit(timeout);
        let Some(recording) = recording else {
            let LoadedPlan { plan, files, kernel } = self.plan(py)?;
            let inputs = files.iter().map(|file| file.path.clone()).collect();
            let options = RunOptions { timeout, stop, ..self.options(files)? };
            return Ok(Planned { plan, options, inputs, kernel });
        };
        self.refuse(&call::BESIDE_RECORDING)?;
        let restored = RecordedRun::restore(recording);
        let (plan, options) =
            restored.map_err(|error| errors::raised(Whose::of_call(!error.is_other_datapath()), &error))?;
        let options = RunOptions { require_hardware: self.require_hardware, stop, ..options };
        Ok(Planned { plan, options, inputs: Vec::new(), kernel: None })
    }

    /// Refuses options that have no effect, as `voided` lists them.
    fn refuse(&self, voided: &Voided) -> PyResult<()> {
        let named = |option: &str| if option == call::FRAMES { "frames" } else { option }.to_owned();
        let is_given = |option: &str| self.given.contains(&named(option));
        voided.refuse(is_given, named).map_err(errors::input)
    }

    fn check(&self) -> PyResult<()> {
        if self.frames.as_ref().is_some_and(Vec::is_empty) {
            return Err(errors::wrong_value(
                "frames holds none; name at least one, or leave it out for the built-in frames",
            ));
        }
        if self.within.is_some() {
            if self.record.is_some() {
                return Err(errors::conflict("within cannot be used with record; give one of them"));
            }
            self.refuse(&call::WITHIN)?;
        }
        if self.record.is_some() {
            self.refuse(&call::WHILE_RECORDED)?;
        }
        if !call::REPEATS.contains(&self.repeat) {
            let (least, most) = (call::REPEATS.start(), call::REPEATS.end());
            return Err(errors::wrong_value(format!(
                "frames cannot be repeated {} times; give {least} to {most}",
                self.repeat
            )));
        }
        Ok(())
    }

    fn plan(&mut self, py: Python<'_>) -> PyResult<LoadedPlan> {
        self.check()?;
        let phase = choices::phase(&self.phase)?;
        let is_free = self.tables.is_none() && self.frames.is_none();
        let LoadedPlan { plan, mut files, kernel } = self.of_tables(py, phase)?;
        let geometry = plan.tables.geometry();
        let frames = match self.frames.take() {
            None => plan.frames.clone(),
            Some(named) => {
                let mut taken = |(place, frame)| source(frame, place, phase, geometry, &mut files);
                named.iter().enumerate().map(&mut taken).collect::<PyResult<_>>()?
            }
        };
        let plan = Plan {
            frames,
            repeat: self.repeat,
            vary: Vary { centre: is_free, depth: is_free },
            at_speed: choices::seconds("at_speed", self.at_speed)?.into(),
            within: choices::within(self.within)?,
            fail_fast: self.fail_fast,
            seed: self.seed,
            ..plan
        };
        plan.check_length().map_err(errors::input)?;
        Ok(LoadedPlan { plan, files, kernel })
    }

    /// A plan with the tables of the call, or else with those of the paper's lens, and the files that they came from.
    fn of_tables(&mut self, py: Python<'_>, phase: Phase) -> PyResult<LoadedPlan> {
        let own;
        let tables = match &self.tables {
            Some(tables) => tables.get(),
            None => {
                own = Tables::of_paper(py)?;
                &own
            }
        };
        let mut chosen = tables.chosen.clone();
        let mut asked = tables.kernel.asked.clone();
        if let Some(kernel) = arguments::kernel(&self.kernel)? {
            let name;
            Kernel { kernel: chosen.kernel, file: chosen.kernel_file, name, asked, .. } = kernel.taken(py)?;
            chosen.source = format!("{}, judged with the {name} kernel", chosen.source);
        }
        let files = tables.files.iter().cloned().chain(chosen.kernel_file.clone()).collect();
        Ok(LoadedPlan { plan: chosen.plan(phase), files, kernel: asked })
    }

    fn options(&mut self, files: Vec<Input>) -> PyResult<RunOptions> {
        if self.retry_limit.is_some_and(|percent| !(0.0..=100.0).contains(&percent)) {
            return Err(errors::wrong_value("retry_limit is no percentage; give 0 to 100"));
        }
        let arguments = std::mem::take(&mut self.arguments);
        let hashes = files.into_iter().map(FileHash::from).collect();
        Ok(RunOptions {
            retry_limit: self.retry_limit.map(RetryLimit::of_percent).unwrap_or_default(),
            reconnect: choices::seconds("reconnect", self.reconnect)?,
            take_over: self.take_over,
            require_hardware: self.require_hardware,
            keep_equal: self.report.is_some(),
            provenance: Provenance {
                arguments,
                files: hashes,
                session_ids: SessionIds::draw(),
                operator: None,
            },
            ..RunOptions::default()
        })
    }
}

/// The frame in the file `path`, and the file as an input of the run.
fn read(path: &Path, how: &ReadOptions) -> Result<(Frame, Input), ReadError> {
    let file = FrameFile::read(path)?;
    Ok((file.decode(how)?.frame, Input::of_bytes(path, file.bytes())))
}

/// Frame `place` of a call: an array, `builtin:NAME`, or a file, which is appended to `files`.
fn source(
    given: &Bound<'_, PyAny>,
    place: usize,
    phase: Phase,
    geometry: &Geometry,
    files: &mut Vec<Input>,
) -> PyResult<FrameSource> {
    if let Ok(name) = given.extract::<String>()
        && let Some(builtin) = Builtin::named(&name).map_err(errors::input)?
    {
        return Ok(FrameSource::Builtin(builtin));
    }
    let depth = geometry.depth();
    let size = PictureSize::Exactly(geometry.width(), geometry.height());
    let how = ReadOptions { depth, phase, size, ..ReadOptions::default() };
    let (path, frame) = if let Ok(path) = given.extract::<PathBuf>() {
        let (frame, input) = given.py().detach(|| read(&path, &how)).map_err(errors::input)?;
        files.push(input);
        (path, frame)
    } else {
        let name = format!("frames[{place}]");
        arguments::check_no_bytes(given, &name)?;
        let frame = frames::frame_of(given, &name, depth.bits(), phase.name())?;
        (name.into(), frame)
    };
    call::check_size(&path, (frame.width(), frame.height()), &how, geometry).map_err(errors::input)?;
    Ok(FrameSource::File { path, frame: Arc::new(frame) })
}
