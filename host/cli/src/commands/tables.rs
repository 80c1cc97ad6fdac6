//! `halfrow tables`

use std::path::{Path, PathBuf};

use clap::Args;

use super::optics::{self, LensArguments};
use super::{Failure, print};
use crate::exit::Exit;
use halfrow::tables::{TableFile, mem};

/// Make a table file: a row factor for every row, and a kernel
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    lens: LensArguments,
    /// The kernel: nearest, linear, keys, hermite, hermite-balanced, sharp5, sharp7, or a file
    #[arg(long, default_value = "hermite", value_name = "NAME|FILE")]
    kernel: String,
    /// Where to: FILE.json, or FILE.mem for two files that Verilog's $readmemh reads
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let chosen = optics::choose(None, &arguments.lens, Some(&arguments.kernel))?;
    let geometry = *chosen.tables.geometry();
    chosen.tables.check_ring(geometry.width().next_power_of_two()).map_err(Failure::call)?;
    let outside = chosen.optics.camera.rows_outside_circle();
    let file = TableFile { tables: chosen.tables, kernel: chosen.kernel, about: about(&chosen.source) };
    let written = write(&file, &arguments.output, arguments.overwrite).map_err(Failure::error)?;
    for path in written {
        print(&format!("wrote {}: {}", path.display(), chosen.source))?;
    }
    if outside > 0 {
        print(&format!("{outside} rows lie outside the image circle and are not stretched"))?;
    }
    Ok(Exit::Pass)
}

fn about(source: &str) -> Option<serde_json::Map<String, serde_json::Value>> {
    let mut about = serde_json::Map::new();
    about.insert("made_by".to_owned(), concat!("halfrow ", env!("CARGO_PKG_VERSION")).into());
    about.insert("from".to_owned(), source.into());
    Some(about)
}

fn write(file: &TableFile, path: &Path, overwrite: bool) -> anyhow::Result<Vec<PathBuf>> {
    if path.extension().is_some_and(|extension| extension == "mem") {
        return Ok(mem::write(path, &file.tables, &file.kernel, overwrite)?);
    }
    file.write(path, overwrite)?;
    Ok(vec![path.to_owned()])
}
