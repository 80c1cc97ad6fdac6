//! Why a bitstream was not loaded, or is not the one that the board runs.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use halfrow::verdict::StoppedBy;
use thiserror::Error;

/// A bitstream that is not loaded.
#[derive(Debug, Error)]
pub(in crate::commands) enum LoadError {
    /// There is no such bitstream: nobody has one before it is built.
    #[error("there is no {}; build it as `halfrow boards` says for each board, or name the file where it is", path.display())]
    Missing { path: PathBuf, source: io::Error },
    /// The record beside the bitstream cannot be understood.
    #[error("{} does not say how a bitstream was made; build it again, or remove that file", path.display())]
    RecordMalformed { path: PathBuf, source: serde_json::Error },
    /// The bitstream is not the one that the record beside it describes.
    #[error(
        "{} is not the bitstream that {} describes; build it again, or copy both files together", path.display(),
        record.display()
    )]
    OtherBitstream { path: PathBuf, record: PathBuf },
    /// Neither the bitstream's record nor the call says which board it is for.
    #[error(
        "nothing beside {} says which board it is for; name the board with --onto: {known} (load another board with its own \
         loader, then ask it with `halfrow info --board TARGET`)", path.display()
    )]
    Nameless { path: PathBuf, known: String },
    /// This program does not know how to load the board that the bitstream is for.
    #[error("{} is for a board `{board}`, and this halfrow can load {known}; use the halfrow that it was built with", path.display())]
    UnknownBoard { path: PathBuf, board: String, known: String },
    /// The bitstream is for another board than the call names.
    #[error("{} is for {board}, and --onto says {named}; leave --onto out, or name another file", path.display())]
    OtherBoard { path: PathBuf, board: String, named: String },
    /// The target is any board of a pool, which need not be the one that is loaded.
    #[error(
        "{target} is any board of its kind, and need not be the one that is loaded; name the place of that one with --board"
    )]
    OfPool { target: String },
    /// The target is a board inside this program, which has no FPGA to load.
    #[error(
        "{target} is a board in this program, with no FPGA behind it; name the place of the one that is loaded with \
         --board"
    )]
    BuiltIn { target: String },
    /// The program that loads the bitstream is not installed.
    #[error(
        "openFPGALoader is not installed; install it (Debian, Ubuntu: `sudo apt install openfpgaloader`, macOS: `brew \
         install openfpgaloader`, others: https://trabucayre.github.io/openFPGALoader), or load the file by hand with \
         `{other}`"
    )]
    LoaderMissing { other: String },
    /// The program that loads the bitstream could not be started, or how it ended is not known.
    #[error("`{call}` cannot be run; check that openFPGALoader may be executed here, or install it again")]
    LoaderNotStarted { call: String, source: io::Error },
    /// The program that loads the bitstream failed.
    #[error(
        "`{call}` failed ({status}): {said}; check that the board is plugged in and powered, that you may open it \
         (scripts/70-halfrow.rules), that it is the board that was named, and that its FPGA is, by the print on it, the {} \
         that the file was built for, or load the file by hand with `{other}`", device.as_deref().unwrap_or("one")
    )]
    LoaderFailed { call: String, status: ExitStatus, said: String, device: Option<String>, other: String },
    /// The program that loads the bitstream took too long and was stopped.
    #[error(
        "`{call}` was killed after {deadline} s: {said}; unplug the board and plug it in, since a loader that is killed \
         leaves it without its port, check the cable and that nothing else uses the board's JTAG, or give it longer with \
         --deadline"
    )]
    LoaderLate { call: String, deadline: f64, said: String },
    /// Somebody stopped the program that loads the bitstream.
    #[error(
        "{by} while `{call}` ran, so the FPGA may hold half of the bitstream; load it again, and if the board's port is gone, \
         unplug the board and plug it in before that"
    )]
    Stopped { call: String, by: StoppedBy },
    /// Somebody stopped the wait for the loaded board.
    #[error(
        "{by} when the bitstream was loaded and the board had not answered yet; load it again to compare its build"
    )]
    NotAwaited { by: StoppedBy },
    /// The board runs another bitstream than the one that was loaded.
    #[error(
        "{target} runs build {board}, but the file that was loaded is build {file}: it is another board than the \
         one that was loaded, or it kept its old bitstream; check which board --board names, and that the bitstream \
         has the link of its USB chip"
    )]
    OtherBuild { target: String, board: String, file: String },
}
