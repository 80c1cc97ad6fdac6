//! `halfrow soak`

use std::time::Duration;

use clap::Args;
use halfrow_program::number::{counted, number};

use super::{Context, Failure};
use crate::arguments::board::refuse_recording;
use crate::arguments::given::Given;
use crate::arguments::judging::{Planned, RunArguments};
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::frames::Builtin;
use halfrow::result::SoakLength;
use halfrow::run::{AtSpeed, FrameSource, Plan, RunOptions};

/// How long a board may stay away if the call does not say: longer than it takes somebody to come by and plug it in again.
const PATIENCE: Duration = Duration::from_secs(300);

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    length: Length,
    #[command(flatten)]
    run: RunArguments,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct Length {
    /// How long, in hours of the link's clock, 0.0001 to 8760
    #[arg(long, value_name = "HOURS", value_parser = number("hours", 0.0001..=8760.0))]
    hours: Option<f64>,
    /// How many frames
    #[arg(long, value_name = "N", value_parser = counted::<u64>(1, None))]
    frames: Option<u64>,
}

impl Length {
    /// The length. clap makes sure that exactly one of the two is given.
    fn asked(&self) -> SoakLength {
        match (self.frames, self.hours) {
            (Some(frames), _) => SoakLength::Frames { frames },
            (None, hours) => SoakLength::Time { seconds: hours.unwrap_or_default() * 3600.0 },
        }
    }
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    let run = &arguments.run;
    refuse_recording(&run.board.named(settings)?)?;
    run.check_inputs(settings)?;
    let (plan, options) = arguments.plan(settings)?;
    let planned = Planned { plan, options, recording: None, inputs: run.input_files(settings) };
    run.judge(planned, None, context)
}

impl Arguments {
    /// The plan and options: what is streamed first, and how long the board makes frames on its own.
    fn plan(&self, settings: &Settings) -> Result<(Plan, RunOptions), Failure> {
        let tables = self.run.table_file(&self.given, settings)?;
        let (chosen, inputs) = self.run.chosen(tables, settings)?;
        let plan = chosen.plan(self.run.lens.phase).frames([FrameSource::Builtin(Builtin::Noise)]);
        let plan =
            Plan { at_speed: AtSpeed::Soak(self.length.asked()), seed: self.run.seed(settings), ..plan };
        // The settings are for all runs, most of which are short, so they may only make the soak more patient.
        let longer = settings.reconnect.filter(|&seconds| seconds > PATIENCE.as_secs_f64());
        let patience = self.run.patience(longer, PATIENCE)?.unwrap_or(PATIENCE);
        Ok((plan, RunOptions { reconnect: Some(patience), ..self.run.options(inputs, settings)? }))
    }
}
