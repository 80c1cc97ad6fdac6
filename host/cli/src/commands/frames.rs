//! `halfrow frames`

use std::path::PathBuf;
use std::str::FromStr as _;

use clap::Args;
use halfrow_program::choice::one_of;
use halfrow_program::files::prepare_files;
use halfrow_program::number::whole_number;
use serde_json::json;

use super::{Context, Failure};
use crate::arguments::given::{Decider, Given};
use crate::arguments::optics::LensArguments;
use crate::console;
use crate::document::tell_result;
use crate::exit::Exit;
use crate::files::make_folder;
use halfrow::frames::{self, Builtin};

#[derive(Debug, Args)]
#[command(mut_args(|argument| Decider::MADE_FRAMES.hides(argument)))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// Only the frame with this name; may be given several times
    #[arg(long, value_name = "NAME", hide_possible_values = true)]
    #[arg(value_parser = one_of(Builtin::ALL.map(Builtin::name), Builtin::from_str))]
    only: Vec<Builtin>,
    /// Seed of the frames noise, extremes and street
    #[arg(long, default_value_t = 1, value_parser = whole_number())]
    seed: u64,
    /// The folder, made if it is not there
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    lens: LensArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    arguments.given.refuse_void(Decider::MADE_FRAMES, &[])?;
    arguments.lens.refuse_field_of_view("a built-in frame")?;
    let scene = arguments.lens.optics()?.scene(arguments.lens.phase, arguments.seed);
    let is_wanted = |frame: &Builtin| arguments.only.is_empty() || arguments.only.contains(frame);
    let chosen: Vec<_> = Builtin::ALL.into_iter().filter(is_wanted).collect();
    let folder = &arguments.output;
    let places: Vec<_> = chosen.iter().map(|frame| folder.join(format!("{}.pgm", frame.name()))).collect();
    prepare_files(
        &context.files(arguments.overwrite).reads(arguments.lens.file()).writes_into("--output", &places),
    )
    .map_err(Failure::call)?;
    make_folder(folder).map_err(Failure::error)?;
    let mut written = Vec::new();
    for (builtin, path) in chosen.iter().zip(places) {
        frames::write(&path, &builtin.render(&scene).map_err(Failure::call)?, arguments.overwrite)
            .map_err(Failure::error)?;
        let (place, description) = (path.display().to_string(), builtin.description());
        if context.json {
            written.push(json!({ "path": place, "name": builtin.name(), "description": description }));
        } else {
            console::tell_line(&format!("{place:<28} {description}"));
        }
    }
    if context.json {
        tell_result("frames", json!({ "files": written }))?;
    }
    Ok(Exit::Pass)
}
