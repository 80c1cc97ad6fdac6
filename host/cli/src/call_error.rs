//! What is wrong with a call, or with a place that it names, for cases that no part of the library reports.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use halfrow::frames::Format;

/// A call that cannot be carried out as it stands. Options are named as they are written on the command line.
#[derive(Debug, Error)]
pub(crate) enum CallError {
    /// A command that prints nothing that could be JSON.
    #[error("`halfrow {command}` has no result in JSON; leave --json out")]
    NoJson { command: &'static str },
    /// A command that is not among those with a document.
    #[error("`{command}` is no command with a document of its own; name one of {known}")]
    NoDocument { command: String, known: String },
    /// A code that nothing has.
    #[error("there is no code `{code}`; {remedy}")]
    CodeUnknown { code: String, remedy: String },
    /// `correct` without a board or the model.
    #[error("nothing is named to correct with; give --model or --board TARGET")]
    NobodyCorrects,
    /// A recording where a board is needed that answers anew, as for new frames.
    #[error(
        "a recording answers only what it was asked when it was made; name another board, or judge it again with \
         `halfrow verify`"
    )]
    RecordingCorrects,
    /// A fault of the mock that a run never comes upon.
    #[error("the fault of {target} would change nothing: {reason}")]
    FaultWithoutEffect { target: String, reason: String },
    /// Ways of making tables, where none are made.
    #[error("a frame has no tables; leave {option} out")]
    RowsOfFrame { option: &'static str },
    /// An option that says something else than a table file.
    #[error(
        "{option} is not that of --tables {}, which is for {width} x {height}, {bits} bits, centre at column {centre}; \
         leave {option} out, or make other tables", path.display()
    )]
    OtherThanTables { option: String, path: PathBuf, width: usize, height: usize, bits: u32, centre: f64 },
    /// The pixels of the frame, where nothing is known of those of the lens's camera.
    #[error("--pixel-pitch does nothing with a lens file unless --lens-pitch is given; give both, or none")]
    PitchAlone,
    /// The pixels of a lens's camera without a lens of a camera.
    #[error("--lens-pitch goes with a lens file; give its name to --lens")]
    LensPitchWithoutFile,
    /// Two ways of saying how long the radius is.
    #[error(
        "--lens equidistant:RADIUS cannot be used with --pixel-pitch or --field-of-view; give the radius alone, or these \
         and --focal-length without it"
    )]
    RadiusTwice,
    /// A way to make row factors beside a grid.
    #[error(
        "--rows says how one factor per row is found, but --projection exact takes a grid of factors; leave out one \
         of the two"
    )]
    RowsOfGrid,
    /// Room for a grid that is not made.
    #[error("--entries is for the grid of --projection exact; leave it out, or give --projection exact too")]
    EntriesOfRows,
    /// A calibration without a size.
    #[error("the lens file {} does not say how large its pictures are; give --width and --height", path.display())]
    LensSizeMissing { path: PathBuf },
    /// A name of tables that says nothing of their format.
    #[error("{} names no format of tables; end it in .json, or in .mem for $readmemh", path.display())]
    TablesFormat { path: PathBuf },
    /// A file name that says another format than the call.
    #[error("{} is no {format}; leave --format out, or name a folder with -o", path.display())]
    OtherFormat { path: PathBuf, format: Format },
    /// One file for several frames.
    #[error("{} is one file for {frames} frames; name a folder with {option}", path.display())]
    OneFile { path: PathBuf, frames: usize, option: &'static str },
    /// Frames to stdout.
    #[error("a frame goes to a file, but `{option} -` names none; give the name of a file or a folder")]
    FramesToStdout { option: &'static str },
    /// An input whose output would have no name.
    #[error("{} has no file name; name a file", path.display())]
    Unnamed { path: PathBuf },
    /// Two frames in one place.
    #[error("two inputs would both be written to {}, or a frame and its preview; give them different names", path.display())]
    FramesShare { path: PathBuf },
    /// A folder that cannot be made.
    #[error("the folder {} cannot be made; name another", path.display())]
    FolderNotMade { path: PathBuf, source: io::Error },
    /// A folder that cannot be looked into.
    #[error("{} cannot be listed; give a folder", path.display())]
    FolderUnlisted { path: PathBuf, source: io::Error },
    /// Folders without a photograph.
    #[error("there is no .png file in the folders of --images")]
    NoPhotograph,
    /// A photograph that would count twice.
    #[error(
        "{} and {} are one photograph, which would count twice; leave one of them out", first.display(), second.display()
    )]
    PhotographTwice { first: PathBuf, second: PathBuf },
    /// Items of the paper that need its photographs.
    #[error(
        "{needing} need the 24 photographs; give --images FOLDER with kodim01.png to kodim24.png \
         (https://r0k.us/graphics/kodak), or name items that need none: {others}"
    )]
    PhotographsMissing { needing: String, others: String },
    /// An input that cannot be read whole.
    #[error("{} cannot be read; name a file that can be", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    /// The station's program does not lie beside this one.
    #[error(
        "the station is a program of its own, and {} is not there; build it with `cargo build --release --package \
         halfrow-station`, or install it with `cargo install --path host/station`", path.display()
    )]
    StationMissing { path: PathBuf },
    /// The station's program does not start.
    #[error("{} cannot be started; build or install it again", path.display())]
    StationNotStarted { path: PathBuf, source: io::Error },
}
