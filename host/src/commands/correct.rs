//! `halfrow correct`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context as _, bail};
use clap::Args;
use halfrow_model::{Frame, correct};
use serde_json::json;

use super::board::BoardArguments;
use super::inputs::{InputArguments, frame_sources};
use super::lens::{self, Chosen, LensArguments};
use super::{Context, Failure, print, print_json};
use crate::board::{Board, BoardError};
use crate::correction::Correction;
use crate::frames::{self, Scene, WriteError};
use crate::progress::Silent;
use crate::session::{self, FrameSource, JUDGED};
use crate::target::BoardKind;
use crate::verdict::Exit;

/// Correct frames with the reference model, or with a board, unjudged
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The frames: PGM, PNG, TIFF, headerless files with --raw, or builtin:NAME
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<String>,
    /// The table file; without it the lens options make the tables
    #[arg(long, value_name = "FILE", env = "HALFROW_TABLES")]
    tables: Option<PathBuf>,
    /// The kernel: nearest, linear, keys, hermite, hermite-balanced, sharp5, sharp7, or a file, instead of the table file's
    #[arg(long, value_name = "NAME|FILE")]
    kernel: Option<String>,
    /// Correct with the reference model, whatever board is set
    #[arg(long)]
    model: bool,
    #[command(flatten)]
    board: BoardArguments,
    /// Where to: a .pgm, .png, .tif or .raw file, or a folder for several frames
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    input: InputArguments,
    #[command(flatten)]
    lens: LensArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    if !arguments.model && !arguments.board.is_named(settings) {
        return Err(anyhow::anyhow!("nobody is named to correct; give --model or --board TARGET").into());
    }
    let file = arguments.tables.as_deref().or(settings.tables.as_deref());
    let kernel = arguments.kernel.as_deref().or(settings.kernel.as_deref());
    let chosen = lens::choose(file, &arguments.lens, kernel)?;
    let geometry = chosen.tables.geometry();
    let how = arguments.input.read_options(geometry, arguments.lens.phase);
    let sources = frame_sources(&arguments.inputs, &how, geometry)?;
    let outputs = outputs(&sources, &arguments.output)?;
    if let Some(taken) = outputs.iter().find(|path| path.exists() && !arguments.overwrite) {
        return Err(
            anyhow::anyhow!("{} is there already; give --overwrite to replace it", taken.display()).into()
        );
    }
    let scene = Scene { geometry: *geometry, ..chosen.optics.scene(arguments.lens.phase, 1) };
    let inputs = sources
        .iter()
        .map(|source| match source {
            FrameSource::File { frame, .. } => Ok(Arc::clone(frame)),
            FrameSource::Builtin(builtin) => builtin.render(&scene).map(Arc::new),
        })
        .collect::<Result<Vec<_>, _>>()?;
    let (board, corrected) = if arguments.model {
        (None, by_model(&chosen, &inputs)?)
    } else {
        let (kind, corrected) = by_board(arguments, context, &chosen, &inputs)?;
        (Some(kind), corrected)
    };
    if arguments.output.extension().is_none() {
        std::fs::create_dir_all(&arguments.output).map_err(Failure::error)?;
    }
    for (path, frame) in outputs.iter().zip(&corrected) {
        frames::write(path, frame, arguments.overwrite).map_err(unwritten)?;
    }
    report(arguments.json, board, &outputs)
}

/// A name without a format is the caller's fault, and nothing was written.
fn unwritten(error: WriteError) -> Failure {
    match error {
        WriteError::Extension { .. } => error.into(),
        error => Failure::error(error),
    }
}

/// Says what was written, and by whom it was corrected: a board, or else the model.
fn report(as_json: bool, board: Option<BoardKind>, outputs: &[PathBuf]) -> Result<Exit, Failure> {
    if as_json {
        let kind = board.map_or_else(|| "model".to_owned(), |kind| kind.to_string());
        let outputs: Vec<_> = outputs.iter().map(|path| path.display().to_string()).collect();
        print_json(
            &json!({ "verdict": null, "exit_code": 0, "board": { "kind": kind }, "outputs": outputs }),
        )?;
    } else {
        let whom = board.map_or_else(|| "model".to_owned(), |kind| format!("{kind} board"));
        for path in outputs {
            print(&format!("wrote {}, corrected by the {whom}, not judged", path.display()))?;
        }
    }
    Ok(Exit::Pass)
}

/// One file for one frame; for several, files of the inputs' names in a folder.
fn outputs(sources: &[FrameSource], output: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let is_file = output.extension().is_some() && !output.is_dir();
    if is_file && sources.len() > 1 {
        bail!("{} is one file for {} frames; name a folder with -o", output.display(), sources.len());
    }
    if is_file {
        return Ok(vec![output.to_owned()]);
    }
    let mut paths = Vec::new();
    for source in sources {
        let name = match source {
            FrameSource::Builtin(builtin) => builtin.name().to_owned(),
            FrameSource::File { path, .. } => path
                .file_stem()
                .context("an input has no file name; name a file")?
                .to_string_lossy()
                .into_owned(),
        };
        let path = output.join(format!("{name}.pgm"));
        if paths.contains(&path) {
            bail!("two inputs would both be written to {}; correct them one by one", path.display());
        }
        paths.push(path);
    }
    Ok(paths)
}

fn by_model(chosen: &Chosen, inputs: &[Arc<Frame>]) -> anyhow::Result<Vec<Frame>> {
    inputs.iter().map(|frame| Ok(correct(&chosen.tables, &chosen.kernel, frame)?)).collect()
}

fn by_board(
    arguments: &Arguments,
    context: &Context,
    chosen: &Chosen,
    inputs: &[Arc<Frame>],
) -> Result<(BoardKind, Vec<Frame>), Failure> {
    let candidate = arguments.board.candidate(&context.settings)?;
    if candidate.kind == BoardKind::Replay {
        return Err(
            anyhow::anyhow!("a recording corrects no new frames; use it with `halfrow verify`").into()
        );
    }
    let options = arguments.board.open_options(&context.settings, None)?;
    let failed = |error: BoardError| Failure { exit: error.exit(), error: error.into() };
    let mut board = Board::open(candidate.link, &options).map_err(|(error, _)| failed(error))?;
    let correction =
        Correction { tables: &chosen.tables, kernel: &chosen.kernel, generation: JUDGED, first_frame: 0 };
    let corrected = match session::misfit(&chosen.tables, &chosen.kernel, &board.capabilities) {
        None => correction.run(&mut board, inputs, &Silent).map_err(failed),
        Some(misfit) => Err(anyhow::anyhow!(misfit).into()),
    };
    // Whatever happened, the next run must find the board free.
    let closed = board.close();
    let corrected = corrected?;
    closed.map_err(failed)?;
    let frames = corrected
        .samples
        .into_iter()
        .zip(inputs)
        .map(|(samples, input)| Frame::new(input.width(), input.depth(), input.phase(), samples))
        .collect::<Result<Vec<_>, _>>()
        .map_err(Failure::error)?;
    Ok((candidate.kind.confirmed_by(board.capabilities.nature), frames))
}
