//! `halfrow frames`

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use super::optics::LensArguments;
use super::{Failure, print, wrong_call};
use crate::exit::Exit;
use halfrow::frames::{self, Builtin};

/// Write the built-in frames as PGM files
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    lens: LensArguments,
    /// Only the frame with this name; may be given several times
    #[arg(long, value_name = "NAME")]
    only: Vec<Builtin>,
    /// Seed of noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The folder, made if it is not there
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if arguments.lens.has_rows() {
        return Err(wrong_call!("a frame has no row factors; leave --rows out"));
    }
    let scene = arguments.lens.optics()?.scene(arguments.lens.phase, arguments.seed);
    let chosen = if arguments.only.is_empty() { &Builtin::ALL[..] } else { &arguments.only };
    let folder = &arguments.output;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{} cannot be made; choose another folder", folder.display()))
        .map_err(Failure::error)?;
    for builtin in chosen {
        let path = folder.join(format!("{}.pgm", builtin.name()));
        frames::write(&path, &builtin.render(&scene).map_err(Failure::call)?, arguments.overwrite)
            .map_err(Failure::error)?;
        print(&format!("{:<28} {}", path.display(), builtin.description()))?;
    }
    Ok(Exit::Pass)
}
