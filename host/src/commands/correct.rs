//! `halfrow correct`

mod places;

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use halfrow_model::{Frame, correct};
use serde_json::json;

use super::board::BoardArguments;
use super::inputs::{InputArguments, frame_sources};
use super::lens::{self, Chosen, LensArguments};
use super::{Context, Failure, print, print_json};
use crate::board::{Board, BoardError};
use crate::correction::Correction;
use crate::frames::{self, Format, Scene, preview};
use crate::progress::Silent;
use crate::session::{self, FrameSource, JUDGED};
use crate::target::BoardKind;
use crate::verdict::Exit;
use places::{Places, Wanted};

/// Correct frames with the reference model, or with a board, unjudged
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The frames: PGM, PNG, TIFF, DNG, headerless files with --raw, or builtin:NAME
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
    /// Where to: a .pgm, .png, .tif, .dng or .raw file, or a folder for several frames
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Format of the files in a folder: pgm, png, tif, dng or raw [default: pgm]
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// Where to put a picture to look at: a .png file, or a folder for several frames
    ///
    /// Each missing colour is the mean of its neighbours; linear light is coded as sRGB, full scale is white, and colours are not
    /// balanced. A raw developer does better with a DNG.
    #[arg(long, value_name = "OUT")]
    preview: Option<PathBuf>,
    /// The samples of the preview are coded for the screen already, as those of a photograph are
    #[arg(long, requires = "preview")]
    preview_coded: bool,
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
    let places = Places::of(&sources, &arguments.wanted())?;
    let scene = Scene { geometry: *geometry, ..arguments.lens.scene(1)? };
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
    arguments.write(&places, &corrected).map_err(Failure::error)?;
    report(arguments.json, board, &places)
}

impl Arguments {
    fn wanted(&self) -> Wanted<'_> {
        let (preview, format) = (self.preview.as_deref(), self.format);
        Wanted { output: &self.output, format, preview, overwrite: self.overwrite }
    }

    fn write(&self, places: &Places, corrected: &[Frame]) -> anyhow::Result<()> {
        places.make_folders()?;
        for (path, frame) in places.frames.iter().zip(corrected) {
            frames::write(path, frame, self.overwrite)?;
        }
        let develop = if self.preview_coded { preview::demosaic_coded } else { preview::demosaic };
        for (path, frame) in places.previews.iter().zip(corrected) {
            frames::write_rgb(path, &develop(frame), self.overwrite)?;
        }
        Ok(())
    }
}

/// Says what was written, and by whom it was corrected: a board, or else the model.
fn report(as_json: bool, board: Option<BoardKind>, places: &Places) -> Result<Exit, Failure> {
    if as_json {
        let kind = board.map_or_else(|| "model".to_owned(), |kind| kind.to_string());
        let [outputs, previews] = [&places.frames, &places.previews]
            .map(|paths| paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
        print_json(&json!({
            "verdict": null, "exit_code": 0, "board": { "kind": kind }, "outputs": outputs, "previews": previews,
        }))?;
        return Ok(Exit::Pass);
    }
    let whom = board.map_or_else(|| "model".to_owned(), |kind| format!("{kind} board"));
    for path in &places.frames {
        print(&format!("wrote {}, corrected by the {whom}, not judged", path.display()))?;
    }
    for path in &places.previews {
        print(&format!("wrote {}, a preview", path.display()))?;
    }
    Ok(Exit::Pass)
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
