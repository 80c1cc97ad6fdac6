//! `halfrow-station plan`

use std::path::PathBuf;

use clap::{Args, Subcommand};
use halfrow::words::{count, plain_lines, span};

use super::beginning::SettingsFile;
use super::{Failure, fetching, print, publish};
use crate::exit::Exit;
use crate::plan::limits::{Limit, Measurement};
use crate::plan::{Again, Bad, JSON_SCHEMA, Plan, Seed, Selected, Shift, Step, StepKind};

/// Look at plans, and have the plant publish them
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Read a plan and every file that it names, and print what would be run
    Check {
        /// The plan
        file: PathBuf,
        /// Only what would be run with the board of this serial number
        #[arg(long)]
        serial: Option<String>,
    },
    /// Print the JSON Schema of plans
    Schema,
    /// Make an engineer's key in a new file, and print what stations know it by
    Key {
        /// The file
        file: PathBuf,
    },
    Publish(publish::Publish),
    Back(publish::Back),
    Published(publish::List),
    /// Fetch the plans of these settings that the plant publishes, as a station does when it starts
    Fetch(SettingsFile),
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    match &arguments.command {
        Command::Check { file, serial } => {
            let plan = Plan::load(file)?;
            print(&match serial {
                Some(serial) => {
                    let (serial, selected) = plan.select(serial)?;
                    format!("{}\n{}", head(&plan), variant(&serial.variant, selected))
                }
                None => {
                    let variants = plan.variants().map(|(name, selected)| variant(name, selected));
                    std::iter::once(head(&plan)).chain(variants).collect::<Vec<_>>().join("\n")
                }
            })
        }
        Command::Schema => print(JSON_SCHEMA.trim_end()),
        Command::Key { file } => publish::key(file),
        Command::Publish(arguments) => publish::publish(arguments),
        Command::Back(arguments) => publish::back(arguments),
        Command::Published(arguments) => publish::list(arguments),
        Command::Fetch(settings) => fetching::fetch_all(settings),
    }
}

fn head(plan: &Plan) -> String {
    let Plan { name, version, product, sha256, builds, .. } = plan;
    let mut lines = vec![
        format!("plan      {name} {version} for {product}"),
        format!("hash      {sha256}"),
        format!("builds    {}", builds.join(", ")),
    ];
    lines.extend(plan.files.iter().map(|file| format!("file      {} {}", file.path, file.sha256)));
    if let Some(Shift { good, bad, lasts }) = &plan.production.shift {
        let span = span(lasts.as_secs_f64());
        let bad = match bad {
            Bad::Unit(serial) => serial.as_str(),
            Bad::Mock => "the mock board with a drawn fault",
        };
        lines.push(format!("shift     {good} passes and {bad} fails in each lane every {span}"));
    }
    match plan.again {
        Again::Allow => {}
        Again::Ask => lines
            .push("again     a unit that passed is tested when somebody says that it is meant".to_owned()),
        Again::Refuse => lines.push("again     a unit that passed is refused".to_owned()),
    }
    if !plan.production.require_hardware {
        lines.push("any kind of board is judged, so no run counts as production".to_owned());
    }
    plain_lines(lines)
}

fn variant(name: &str, selected: &Selected) -> String {
    let title =
        if name.is_empty() { "no variant that is named".to_owned() } else { format!("variant {name}") };
    let steps = selected.steps.iter().zip(1..).map(|(step, seq)| format!("  {seq} {}", told(step)));
    let limits = selected.limits.iter().map(|limit| format!("  limit {}", bounds(limit)));
    plain_lines(std::iter::once(title).chain(steps).chain(limits))
}

fn told(step: &Step) -> String {
    let what = match &step.kind {
        StepKind::Identity => "the board is asked who it is".to_owned(),
        StepKind::Link { each } => format!("the link is tested in parts of {} s", each.as_secs_f64()),
        StepKind::Verify(judging) => {
            let names: Vec<_> = judging.frames.iter().map(halfrow::FrameSource::name).collect();
            let seed = match judging.seed {
                Seed::Run => "of the run".to_owned(),
                Seed::Fixed(seed) => seed.to_string(),
            };
            let at_speed = match judging.at_speed {
                None => String::new(),
                Some(time) => format!(", {} s at full speed", time.as_secs_f64()),
            };
            let frames = names.join(", ");
            format!(
                "{} x {frames}, and what every run streams beside them{at_speed}, by {}, seed {seed}",
                judging.repeat, judging.chosen.source
            )
        }
    };
    let tries = match step.retries {
        0 => String::new(),
        some => format!(", tried again {}", count(some, "time")),
    };
    format!("{}: {what}{tries}, within {} s", step.name, step.timeout.as_secs_f64())
}

fn bounds(limit: &Limit) -> String {
    let side = |word: &str, bound: Option<f64>| bound.map(|bound| format!(" {word} {bound}"));
    let sides = [side("at least", limit.least), side("at most", limit.most)].into_iter().flatten();
    let Measurement { name, unit, .. } = limit.measurement;
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    format!("{name}{}{unit}, blames {}", sides.collect::<String>(), limit.blames)
}
