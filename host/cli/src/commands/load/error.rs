//! Why a bitstream was not loaded, or is not the one that the board runs.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use thiserror::Error;

/// A bitstream that is not loaded.
#[derive(Debug, Error)]
pub(in crate::commands) enum LoadError {
    /// A record that cannot be read as one.
    #[error("{} does not say how a bitstream was made; build it again, or remove that file", path.display())]
    RecordMalformed { path: PathBuf, source: serde_json::Error },
    /// A bitstream that is not the one of its record.
    #[error(
        "{} is not the bitstream that {} describes; build it again, or copy both files together", path.display(),
        record.display()
    )]
    OtherBitstream { path: PathBuf, record: PathBuf },
    /// Nobody says which board a bitstream is for.
    #[error("nothing beside {} says which board it is for; name the board with --onto: {known}", path.display())]
    Nameless { path: PathBuf, known: String },
    /// A board that this program does not know how to load.
    #[error("{} is for a board `{board}`, and this halfrow can load {known}; use the halfrow that it was built with", path.display())]
    UnknownBoard { path: PathBuf, board: String, known: String },
    /// A bitstream for another board than the call's.
    #[error("{} is for {board}, and --onto says {named}; leave --onto out, or name another file", path.display())]
    OtherBoard { path: PathBuf, board: String, named: String },
    /// A board of a pool, which may be any of its kind.
    #[error(
        "{target} is any board of its kind, and need not be the one that is loaded; name the place of that one with --board"
    )]
    OfPool { target: String },
    /// A board in this program.
    #[error(
        "{target} is a board in this program, with no FPGA behind it; name the place of the one that is loaded with \
         --board"
    )]
    BuiltIn { target: String },
    /// No loader.
    #[error(
        "openFPGALoader is not installed; install it (Debian, Ubuntu: `sudo apt install openfpgaloader`, macOS: `brew \
         install openfpgaloader`, others: https://trabucayre.github.io/openFPGALoader), or load the file by hand with \
         `{other}`"
    )]
    LoaderMissing { other: String },
    /// A loader that does not start, or whose end nobody knows.
    #[error("`{call}` cannot be run; check that openFPGALoader may be executed here, or install it again")]
    LoaderNotStarted { call: String, source: io::Error },
    /// A loader that failed.
    #[error(
        "`{call}` failed ({status}): {said}; check that the board is plugged in and powered, that you may open it \
         (scripts/70-halfrow.rules), and that it is the board that was named"
    )]
    LoaderFailed { call: String, status: ExitStatus, said: String },
    /// A loader that took too long.
    #[error(
        "`{call}` was killed after {deadline} s: {said}; check the cable and that nothing else uses the board's JTAG, or \
         give it longer with --deadline"
    )]
    LoaderLate { call: String, deadline: f64, said: String },
    /// A board that runs another bitstream than the one that was loaded.
    #[error(
        "{target} runs build {board}, but the file that was loaded is build {file}: it is another board than the \
         one that was loaded, or it kept its old bitstream; check which board --board names, and that the bitstream \
         has the link of its USB chip"
    )]
    OtherBuild { target: String, board: String, file: String },
}
