//! `halfrow-station demo`

use std::path::{self, PathBuf};

use clap::Args;

use super::Failure;
use super::beginning::{Disk, settings};
use super::serve::{Served, serve};
use crate::console;
use crate::demo::{Demo, MOST_LANES, serials};
use crate::exit::Exit;
use crate::web::{User, Who};

/// Show a station at work: mock boards, some of them broken, and its pages in a browser
///
/// Boards come by themselves; the last lane is yours. Everything lies in a folder of its own, and nothing leaves this computer.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// How many lanes, 1 to 16
    #[arg(long, default_value_t = 4, value_parser = lanes)]
    lanes: usize,
    /// The port of the pages; with 0 the system chooses one
    #[arg(long, default_value_t = 8612)]
    port: u16,
    /// A new folder for all of it, which is kept [default: one that is removed at the end]
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    disk: Disk,
}

fn lanes(text: &str) -> Result<usize, String> {
    let lanes = text.parse().ok().filter(|lanes| (1..=MOST_LANES).contains(lanes));
    lanes.ok_or_else(|| format!("give 1 to {MOST_LANES}"))
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let aside = tempfile::tempdir().map_err(Failure::error)?;
    let folder = arguments.folder.clone().unwrap_or_else(|| aside.path().to_owned());
    let folder = path::absolute(folder).map_err(Failure::call)?;
    // A folder that goes with the program has nothing to lose, wherever it lies.
    let disk = arguments.disk.unless(arguments.folder.is_none());
    disk.takes(&folder)?;
    let demo =
        Demo::new(&folder, arguments.lanes, arguments.port).map_err(|error| {
            Failure::call(anyhow::Error::from(error).context(format!(
                "the demonstration cannot be made in {}; name a new folder",
                folder.display()
            )))
        })?;
    let settings = settings(&demo.settings)?;
    console::tell("A demonstration: no board is real. Ctrl-C ends it.");
    // Whoever opens the pages may do everything.
    let everybody = User { name: "visitor".to_owned(), who: Who::Engineer };
    let hints = serials(&settings);
    let served = Served { settings: &settings, disk: &disk, everybody, hints };
    serve(served, |engine| demo.start(engine, &settings))
}
