//! What is wrong with a call, or with a place that it names, for cases that no part of the library reports.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use halfrow::frames::Format;
use halfrow::verdict::StoppedBy;

/// A call that cannot be carried out as it stands. Options are named as they are written on the command line.
#[derive(Debug, Error)]
pub(crate) enum CallError {
    /// The command prints nothing that could be JSON.
    #[error("`halfrow {command}` has no result in JSON; leave --json out")]
    NoJson { command: &'static str },
    /// The command has no JSON document with a schema of its own.
    #[error("`{command}` is no command with a document of its own; name one of {known}")]
    NoDocument { command: String, known: String },
    /// No code or other word of a report has this name.
    #[error("there is no code `{code}`; {remedy}")]
    CodeUnknown { code: String, remedy: String },
    /// The command `correct` was given neither a board nor the model.
    #[error("neither a board nor the model is named to correct with; give --model or --board TARGET")]
    NobodyCorrects,
    /// A recording was named where a board must answer what it was not asked before.
    #[error(
        "a recording answers only what it was asked when it was made; name another board, or judge it again with \
         `halfrow verify`"
    )]
    RecordingAnswersNothingNew,
    /// The mock board's fault cannot show in this run.
    #[error("the fault of {target} would change nothing: {reason}")]
    FaultWithoutEffect { target: String, reason: String },
    /// An option says something else than the table file.
    #[error(
        "{option} contradicts --tables {}, which is for {width} x {height}, {bits} bits, centre at column {centre}; \
         leave {option} out, or make other tables", path.display()
    )]
    OtherThanTables { option: String, path: PathBuf, width: usize, height: usize, bits: u32, centre: f64 },
    /// The pitch of the frame's pixels was given for a lens file, without the pitch of the lens's own camera.
    #[error("--pixel-pitch does nothing with a lens file unless --lens-pitch is given; give both, or none")]
    PitchAlone,
    /// The pitch of a lens's camera was given without a lens file.
    #[error("--lens-pitch goes with a lens file; give its name to --lens")]
    LensPitchWithoutFile,
    /// The lens's radius was given in two ways.
    #[error(
        "--lens equidistant:RADIUS cannot be used with --pixel-pitch or --field-of-view; give the radius alone, or these \
         and --focal-length without it"
    )]
    RadiusTwice,
    /// A way to make row factors was given, but a grid was asked for.
    #[error(
        "--rows says how one factor per row is found, but --projection exact takes a grid of factors; leave out one \
         of the two"
    )]
    RowsOfGrid,
    /// A number of entries or a distance of nodes was given, but no grid was asked for.
    #[error(
        "--entries and --nodes-every are for the grid of --projection exact; leave them out, or give --projection exact too"
    )]
    EntriesOfRows,
    /// An angle across the image circle was given where nothing depends on it.
    #[error(
        "--field-of-view does nothing here: without a lens file it changes how far tables of one factor per row reach, and \
         nothing of {what}; leave it out"
    )]
    FieldOfViewVoid { what: &'static str },
    /// The lens file does not give the size of its pictures.
    #[error(
        "the lens file {} does not say how large its pictures are; add image_width and image_height to it, or give --width and \
         --height if the frames have the size of its pictures",
        path.display()
    )]
    LensSizeMissing { path: PathBuf },
    /// The file's name says another format than the option.
    #[error("{} is no {format}; leave --format out, or name a folder with -o", path.display())]
    OtherFormat { path: PathBuf, format: Format },
    /// One file was named for several frames.
    #[error("{} is one file for {frames} frames; name a folder with {option}", path.display())]
    OneFile { path: PathBuf, frames: usize, option: &'static str },
    /// The input has no file name to name its output after.
    #[error("{} has no file name; name a file", path.display())]
    Unnamed { path: PathBuf },
    /// Two frames would be written to the same file.
    #[error("two inputs would both be written to {}, or a frame and its preview; give them different names", path.display())]
    FramesShare { path: PathBuf },
    /// The folder cannot be made.
    #[error("the folder {} cannot be made; name another", path.display())]
    FolderNotMade { path: PathBuf, source: io::Error },
    /// The files in the folder cannot be listed.
    #[error("{} cannot be listed; give a folder", path.display())]
    FolderUnlisted { path: PathBuf, source: io::Error },
    /// The folders hold no photograph.
    #[error("there is no .png file in the folders of --images")]
    NoPhotograph,
    /// Two files hold the same photograph, which would count twice.
    #[error(
        "{} and {} are one photograph, which would count twice; leave one of them out", first.display(), second.display()
    )]
    PhotographTwice { first: PathBuf, second: PathBuf },
    /// Some of the items that were asked for need the paper's photographs.
    #[error(
        "{needing} need the 24 photographs; give --images FOLDER with kodim01.png to kodim24.png \
         (https://r0k.us/graphics/kodak), or name items that need none: {others}"
    )]
    PhotographsMissing { needing: String, others: String },
    /// Somebody stopped a command that judges nothing.
    #[error("{by} before it was done; run again")]
    Stopped { by: StoppedBy },
    /// The input could not be read as a whole.
    #[error("cannot read {}; check that it exists and that you may read it", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    /// The station's program is not beside this one.
    #[error(
        "the station is a program of its own, and {} is not there; build it with `cargo build --release --package \
         halfrow-station`, or install it with `cargo install --locked --path host/station`", path.display()
    )]
    StationMissing { path: PathBuf },
    /// The station's program could not be started.
    #[error("{} cannot be started; build or install it again", path.display())]
    StationNotStarted { path: PathBuf, source: io::Error },
}
