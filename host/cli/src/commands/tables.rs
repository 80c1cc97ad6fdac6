//! `halfrow tables`

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use clap::Args;
use halfrow_program::files::prepare_files;
use serde_json::json;

use super::{Context, Failure};
use crate::arguments::given::{Decider, Given};
use crate::arguments::optics::{self, LensArguments};
use crate::console;
use crate::document::tell_result;
use crate::exit::Exit;
use halfrow::call::refuse_stdout;
use halfrow::optics::outside_circle;
use halfrow::tables::{TableFile, TableFormat};
use halfrow::words::count;

#[derive(Debug, Args)]
#[command(mut_args(|argument| Decider::MADE_TABLES.hides(argument)))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    #[arg(long, help = optics::kernel_help(" [default: hermite]"), value_name = "NAME|FILE", env = "HALFROW_KERNEL")]
    kernel: Option<OsString>,
    /// Where to: FILE.json, or FILE.mem for two files that Verilog's $readmemh reads
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    lens: LensArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    arguments.given.refuse_void(Decider::MADE_TABLES, &[])?;
    refuse_stdout("--output", &arguments.output).map_err(Failure::call)?;
    let format = TableFormat::of(&arguments.output).map_err(Failure::call)?;
    let of_settings = context.settings.kernel.as_deref().map(OsStr::new);
    let kernel = arguments.kernel.as_deref().or(of_settings);
    prepare_files(
        &context
            .files(arguments.overwrite)
            .reads(arguments.lens.file())
            .reads_kernel(kernel)
            .writes("--output", format.places(&arguments.output)),
    )
    .map_err(Failure::call)?;
    let chosen = optics::choose(None, &arguments.lens, kernel)?;
    let outside = chosen.rows_outside_circle.unwrap_or_default();
    let how = outside_circle(&chosen.tables);
    let file = TableFile { tables: chosen.tables, kernel: chosen.kernel, about: about(&chosen.source) };
    format.write(&file, &arguments.output, arguments.overwrite).map_err(Failure::error)?;
    if context.json {
        let places = format.places(&arguments.output);
        let names: Vec<_> = places.iter().map(|path| path.display().to_string()).collect();
        let rest = json!({ "files": names, "source": chosen.source, "rows_outside_circle": outside });
        tell_result("tables", rest)?;
        return Ok(Exit::Pass);
    }
    for path in format.places(&arguments.output) {
        console::tell_line(&format!("wrote {}: {}", path.display(), chosen.source));
    }
    if outside > 0 {
        console::tell(&format!("{} outside the image circle: {how}", count(outside, "row")));
    }
    Ok(Exit::Pass)
}

fn about(source: &str) -> Option<serde_json::Map<String, serde_json::Value>> {
    let mut about = serde_json::Map::new();
    about.insert("made_by".to_owned(), format!("halfrow {}", halfrow::VERSION).into());
    about.insert("from".to_owned(), source.into());
    Some(about)
}
