//! `halfrow verify`

mod listing;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use clap::builder::TypedValueParser;
use halfrow_program::number::{any, counted};

use super::{Context, Failure};
use crate::arguments::board::{self, MOCK, Replays};
use crate::arguments::given::{Decider, Given};
use crate::arguments::inputs::{FrameName, InputArguments, frame_sources, tell_fitting};
use crate::arguments::judging::{Planned, RunArguments, seconds};
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::call::{self, Input};
use halfrow::files::check_regular;
use halfrow::frames::Builtin;
use halfrow::link::Recording;
use halfrow::optics::Chosen;
use halfrow::run::{FrameSource, Plan, RecordedRun, RunOptions, Vary};

#[derive(Debug, Args)]
#[command(mut_args(|argument| board::helped(argument, Replays::Yes, MOCK)))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// A frame to stream instead of the built-in ones: a file (PGM, PNG, TIFF, DNG, JPEG, WebP, BMP), or builtin:NAME; may be
    /// given several times
    #[arg(long, value_name = "FILE", env = "HALFROW_FRAME")]
    frame: Vec<OsString>,
    /// How often to stream the frames, 1 to 1000
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = repeats())]
    repeat: u32,
    /// Let the board make frames at its full pixel clock for this many seconds of that clock, at most 1e9, 0 for none
    /// [default: 3 on hardware, three frames on any other board]
    #[arg(long, value_name = "SECONDS", env = "HALFROW_AT_SPEED", value_parser = any::<f64>("a number of seconds"))]
    at_speed: Option<f64>,
    /// Judge within this many seconds, at most 1,000,000, by the parts of the run that find the most faults per second
    #[arg(long, value_name = "SECONDS", value_parser = within, conflicts_with_all = ["record", "list"])]
    within: Option<Duration>,
    /// Stop at the first wrong frame
    #[arg(long)]
    fail_fast: bool,
    /// Only list what would be streamed, and what each part would cost on the link
    #[arg(long)]
    list: bool,
    /// Record the run to FILE, to be judged again with --board replay:FILE
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    #[command(flatten)]
    run: RunArguments,
    #[command(flatten)]
    input: InputArguments,
}

fn within(text: &str) -> Result<Duration, String> {
    let time = text.parse().ok().and_then(call::within);
    time.ok_or_else(|| call::WITHIN_TAKES.to_owned())
}

fn repeats() -> impl TypedValueParser<Value = u32> {
    let (least, most) = call::REPEATS.into_inner();
    counted(u64::from(least), Some(u64::from(most)))
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    if arguments.list {
        arguments.given.refuse_void(Decider::LIST, &settings.keys())?;
    }
    let recording = arguments.run.board.recording(settings)?;
    let frames = arguments.frames(settings)?;
    let inputs = arguments.input_files(&frames, settings);
    let (plan, options) = arguments.planned(recording.as_ref(), frames, context)?;
    if arguments.list {
        // The cost of a run can be computed without the device.
        let target = arguments.run.board.named(settings)?;
        board::check(&target)?;
        board::check_fault(&target, &plan)?;
        return listing::list(&plan, &target, context.json);
    }
    let planned = Planned { plan, options, recording, inputs };
    arguments.run.judge(planned, arguments.record.as_deref(), context)
}

fn wrong_frame(error: impl Into<anyhow::Error>) -> Failure {
    Failure::call(error).in_value_of("--frame")
}

impl Arguments {
    /// The plan and options of the run, or of the run in `recording`.
    fn planned(
        &self,
        recording: Option<&Recording>,
        frames: Vec<FrameName>,
        context: &Context,
    ) -> Result<(Plan, RunOptions), Failure> {
        let settings = &context.settings;
        let (plan, options) = match recording {
            Some(recording) => {
                self.given.refuse_void(Decider::RECORDING, &settings.keys())?;
                let (plan, mut options) = RecordedRun::restore(recording)?;
                options.provenance.operator = self.run.operator();
                let require_hardware = self.run.requires_hardware(settings);
                (plan, RunOptions { require_hardware, ..options })
            }
            None => self.plan(frames, context)?,
        };
        plan.check_length().map_err(Failure::call)?;
        Ok((plan, options))
    }

    /// The plan and options of the run, from the command's options.
    fn plan(&self, frames: Vec<FrameName>, context: &Context) -> Result<(Plan, RunOptions), Failure> {
        let settings = &context.settings;
        if frames.iter().all(|frame| frame.file().is_none()) {
            self.given.refuse_void(Decider::NO_FRAME_FILE, &[])?;
        }
        if self.within.is_some() {
            self.given.refuse_void(Decider::WITHIN, &settings.keys())?;
        }
        if self.record.is_some() {
            self.given.refuse_void(Decider::RECORD, &settings.keys())?;
        }
        self.input.refuse_void(&self.given, settings)?;
        // The report names each file with its hash.
        self.run.check_inputs(settings)?;
        frames.iter().filter_map(FrameName::file).try_for_each(check_regular).map_err(wrong_frame)?;
        let tables = self.run.table_file(&self.given, settings)?;
        let is_free = tables.is_none() && frames.is_empty();
        let (chosen, mut inputs) = self.run.chosen(tables, settings)?;
        let plan = self.plan_of(chosen, frames, &mut inputs, context)?;
        let plan = Plan { vary: self.vary(is_free), ..plan };
        // A recording holds one connection only.
        let options = self.run.options(inputs, settings)?;
        let reconnect = options.reconnect.filter(|_| self.record.is_none());
        Ok((plan, RunOptions { reconnect, ..options }))
    }

    /// What is varied if neither tables nor frames are named (`is_free`): whatever the call does not set.
    fn vary(&self, is_free: bool) -> Vary {
        let has_centre = self.given.is_flag("centre_x") || self.run.lens.file().is_some();
        Vary { centre: is_free && !has_centre, depth: is_free && !self.given.is_flag("bits") }
    }

    /// The plan with the tables `chosen` and these `frames`, whose files are appended to `inputs`.
    fn plan_of(
        &self,
        chosen: Chosen,
        frames: Vec<FrameName>,
        inputs: &mut Vec<Input>,
        context: &Context,
    ) -> Result<Plan, Failure> {
        let settings = &context.settings;
        let (geometry, phase) = (chosen.tables.geometry(), self.run.lens.phase);
        let how = self.input.read_options(geometry, phase, settings);
        let frames = if frames.is_empty() {
            Builtin::ALL.into_iter().map(FrameSource::Builtin).collect()
        } else {
            let tell = |path: &Path, fitting| tell_fitting(path, fitting, context.quiet);
            frame_sources(frames, &how, geometry, inputs, tell).map_err(wrong_frame)?
        };
        Ok(Plan {
            frames,
            repeat: self.repeat,
            at_speed: seconds("--at-speed", self.at_speed.or(settings.at_speed))?.into(),
            within: self.within,
            fail_fast: self.fail_fast,
            seed: self.run.seed(settings),
            ..chosen.plan(phase)
        })
    }

    /// The frames that are named; none means all built-in frames, and `--within` chooses among these only.
    fn frames(&self, settings: &Settings) -> Result<Vec<FrameName>, Failure> {
        match settings.frame.as_deref() {
            _ if self.within.is_some() => return Ok(Vec::new()),
            Some(names) if self.frame.is_empty() => FrameName::all(names),
            _ => FrameName::all(&self.frame),
        }
        .map_err(wrong_frame)
    }

    /// The files of the tables, the lens and the frames.
    fn input_files(&self, frames: &[FrameName], settings: &Settings) -> Vec<PathBuf> {
        let frames = frames.iter().filter_map(FrameName::file).map(PathBuf::from);
        self.run.input_files(settings).into_iter().chain(frames).collect()
    }
}
