//! `halfrow correct`

mod by_board;
mod by_model;
mod places;

use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::str::FromStr as _;
use std::sync::{Mutex, OnceLock, PoisonError};

use clap::Args;
use halfrow_model::Frame;
use halfrow_program::choice::one_of;
use halfrow_program::files::prepare_files;
use serde_json::{Value, json};

use super::{Context, Failure};
use crate::arguments::board::{self, BoardArguments, Replays};
use crate::arguments::given::{Decider, Given};
use crate::arguments::inputs::{FrameName, InputArguments, tell_fitting};
use crate::arguments::optics::{self, LensArguments};
use crate::arguments::table_file::TableArgument;
use crate::call_error::CallError;
use crate::console;
use crate::document::tell_result;
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::frames::{self, Camera, Fitting, Format, ReadOptions, Scene, WriteError, parallel, preview};
use halfrow::optics::Chosen;
use halfrow::target::BoardKind;
use places::{Places, Wanted};

#[derive(Debug, Args)]
#[command(mut_args(|argument| board::helped(argument, Replays::No, "")))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// The frames: PGM, PNG, TIFF, DNG, JPEG, WebP, BMP, headerless files with --raw, or builtin:NAME
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<OsString>,
    #[command(flatten)]
    tables: TableArgument,
    #[arg(long, value_name = "NAME|FILE", help = optics::kernel_help(", instead of the table file's"), env = "HALFROW_KERNEL")]
    kernel: Option<OsString>,
    /// Correct with the reference model, whatever board is set
    #[arg(long)]
    model: bool,
    /// Where to: a .pgm, .png, .tif, .dng or .raw file, or a folder for several frames
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Format of the files in a folder: pgm, png, tif, dng or raw [default: pgm]
    #[arg(long, value_name = "FORMAT", hide_possible_values = true)]
    #[arg(value_parser = one_of(Format::ALL.map(Format::extension), Format::from_str))]
    format: Option<Format>,
    /// Where to put a picture to look at: a .png file, or a folder for several frames
    ///
    /// Each missing colour is the mean of its neighbours; linear light is coded as sRGB, full scale is white, and colours are not
    /// balanced. A raw developer does better with a DNG.
    #[arg(long, value_name = "OUT")]
    preview: Option<PathBuf>,
    /// The samples of the preview are coded for the screen already, as those of a JPEG, WebP or BMP are known to be
    #[arg(long, requires = "preview")]
    preview_coded: bool,
    /// Replace files that are there
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    input: InputArguments,
    #[command(flatten)]
    lens: LensArguments,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let settings = &context.settings;
    if !arguments.model && !arguments.board.is_named(settings) {
        return Err(Failure::call(CallError::NobodyCorrects));
    }
    let inputs = FrameName::all(&arguments.inputs).map_err(Failure::call)?;
    arguments.refuse_void(&inputs, settings)?;
    let places = Places::of(&inputs, &arguments.wanted()).map_err(Failure::call)?;
    let kernel = arguments.kernel.as_deref().or(settings.kernel.as_deref().map(OsStr::new));
    let files = arguments
        .board
        .files_if(!arguments.model, arguments.overwrite, context)?
        .reads(arguments.tables.path(settings))
        .reads(arguments.lens.file())
        .reads_kernel(kernel);
    let tables = arguments.tables.read(&arguments.given, &arguments.lens, settings)?;
    let chosen = optics::choose(tables, &arguments.lens, kernel)?;
    let geometry = *chosen.tables.geometry();
    let job = Job {
        arguments,
        fittings: inputs.iter().map(|_| OnceLock::new()).collect(),
        inputs,
        written: Mutex::default(),
        kind: OnceLock::new(),
        how: arguments.input.read_options(&geometry, arguments.lens.phase, settings),
        scene: Scene { geometry, ..chosen.optics.scene(arguments.lens.phase, 1) },
        chosen,
        quiet: context.quiet,
    };
    job.check().map_err(Failure::call)?;
    let files = places.add_to(files.reads(job.inputs.iter().filter_map(FrameName::file)));
    prepare_files(&files).map_err(Failure::call)?;
    let watched = context.progress();
    watched.rows_expected((job.inputs.len() * geometry.height()) as u64);
    let corrected = if arguments.model {
        job.by_model(&places, watched.as_ref())
    } else {
        job.by_board(&places, context, watched.as_ref())
    };
    watched.done();
    job.report(context.json, corrected, &places)
}

/// How a frame is shown.
#[derive(Clone, Default)]
struct Look {
    camera: Camera,
    /// Whether its colours are coded for the screen.
    is_coded: bool,
}

/// What is to be corrected, and how.
struct Job<'a> {
    arguments: &'a Arguments,
    inputs: Vec<FrameName>,
    /// How each of them was fitted, once it has been.
    fittings: Vec<OnceLock<Fitting>>,
    /// The files that are in place.
    written: Mutex<HashSet<PathBuf>>,
    /// The kind of the board, once one is open.
    kind: OnceLock<BoardKind>,
    how: ReadOptions,
    scene: Scene,
    chosen: Chosen,
    /// Whether nothing is said of how pictures are fitted.
    quiet: bool,
}

impl Job<'_> {
    /// Checks, before anything is written, that all files exist and have the right size. Says on stderr how pictures are fitted.
    fn check(&self) -> anyhow::Result<()> {
        let is_checked = |input: &FrameName| input.file().is_some() && input.can_be_read_twice();
        let files: Vec<_> = self.inputs.iter().enumerate().filter(|(_, input)| is_checked(input)).collect();
        // Most formats are decoded whole for this.
        let fittings =
            parallel::map(&files, |_, (_, input)| anyhow::Ok(input.rows(&self.how, &self.scene)?.fitting()));
        for ((index, _), fitting) in files.iter().zip(fittings) {
            self.note(*index, fitting?);
        }
        Ok(())
    }

    /// Keeps how the input with this index was fitted, and says it on stderr.
    fn note(&self, index: usize, fitting: Option<Fitting>) {
        let (Some(path), Some(found)) = (self.inputs[index].file(), fitting) else { return };
        self.fittings[index].get_or_init(|| found);
        tell_fitting(path, fitting, self.quiet);
    }

    /// [`Self::note`], unless [`Self::check`] could look at this input.
    fn note_unchecked(&self, index: usize, fitting: Option<Fitting>) {
        if !self.inputs[index].can_be_read_twice() {
            self.note(index, fitting);
        }
    }

    /// Writes the preview of the frame with this index, if previews are asked for.
    fn write_preview(
        &self,
        places: &Places,
        index: usize,
        look: &Look,
        corrected: &Frame,
    ) -> Result<(), WriteError> {
        let Some(path) = places.previews.get(index) else { return Ok(()) };
        let is_coded = self.arguments.preview_coded || look.is_coded;
        let develop = if is_coded { preview::demosaic_coded } else { preview::demosaic };
        frames::write_rgb(
            path,
            &develop(corrected).turned(look.camera.orientation),
            self.arguments.overwrite,
        )?;
        self.note_written(path);
        Ok(())
    }

    fn note_written(&self, path: &Path) {
        self.written.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }

    /// Prints what was written, by which tables it was corrected, and by which kind of board, or by the model. What is in place
    /// when the rest fails is in the way of the next call.
    fn report(
        &self,
        as_json: bool,
        corrected: Result<(), Failure>,
        places: &Places,
    ) -> Result<Exit, Failure> {
        let written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let [frames, previews] = [&places.frames, &places.previews]
            .map(|paths| paths.iter().filter(|path| written.contains(*path)).collect::<Vec<_>>());
        if written.is_empty()
            && let Err(failure) = corrected
        {
            return Err(failure);
        }
        let (tables, board) = (&self.chosen.source, self.kind.get());
        if as_json {
            let kind = board.map_or_else(|| "model".to_owned(), ToString::to_string);
            let [outputs, previews] = [frames, previews]
                .map(|paths| paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>());
            let of_frames = self.fittings.iter().zip(&places.frames);
            let fitted: Vec<_> = of_frames
                .filter(|(_, path)| written.contains(*path))
                .map(|(fitting, _)| fitting.get().map(fitting_json))
                .collect();
            let rest = json!({
                "corrected_by": kind,
                "tables": tables,
                "outputs": outputs,
                "previews": previews,
                "fitted": fitted,
            });
            if let Err(failure) = corrected {
                return Err(Failure { so_far: Some(rest), ..failure });
            }
            tell_result("correct", rest)?;
            return Ok(Exit::Pass);
        }
        let whom = board.map_or_else(|| "model".to_owned(), |kind| format!("{kind} board"));
        for path in frames {
            console::tell_line(&format!("wrote {}, corrected by the {whom}, not judged", path.display()));
        }
        for path in previews {
            console::tell_line(&format!("wrote {}, a preview", path.display()));
        }
        console::tell_line(&format!("tables: {tables}"));
        corrected.map(|()| Exit::Pass)
    }
}

impl Arguments {
    /// Refuses options that do nothing for these inputs.
    fn refuse_void(&self, inputs: &[FrameName], settings: &Settings) -> Result<(), Failure> {
        if inputs.iter().all(|input| input.file().is_none()) {
            self.given.refuse_void(Decider::NO_FRAME_FILE, &[])?;
        }
        if self.model {
            self.given.refuse_void(Decider::MODEL, &settings.keys())?;
        }
        self.input.refuse_void(&self.given, settings)
    }

    fn wanted(&self) -> Wanted<'_> {
        let (preview, format) = (self.preview.as_deref(), self.format);
        Wanted { output: &self.output, format, preview }
    }
}

fn fitting_json(Fitting { found, cropped, wanted }: &Fitting) -> Value {
    let size = |(width, height): &(usize, usize)| json!({ "width": width, "height": height });
    json!({ "found": size(found), "cropped": size(cropped), "wanted": size(wanted) })
}
