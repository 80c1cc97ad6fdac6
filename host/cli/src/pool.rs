//! Boards that several computers share: `pool:KIND` is any free board of that kind, for as long as this program runs.
//!
//! `halfrow-station board hold` waits for a board at the plant and holds it until its stdin ends, which happens when this program
//! ends, in whatever way. So this program needs no database.

use std::ffi::OsStr;
use std::io::{self, BufRead as _, BufReader};
use std::os::unix::process::CommandExt as _;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use halfrow::target::{Target, TargetError};
use serde::Deserialize;

use crate::beside::{self, STATION};
use crate::console;

/// The kind of a target that means any board of some kind.
pub(crate) const POOL: &str = "pool";
/// How often the wait is reported when nothing has changed, in seconds.
const TOLD: u64 = 10;

/// The board that was leased, until the program ends.
static LENT: Mutex<Option<Lent>> = Mutex::new(None);
/// Whether the lease was lost.
static LOST: AtomicBool = AtomicBool::new(false);

/// No board was got.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PoolError {
    /// The target `pool` does not say which kind of board is wanted.
    #[error("`pool` needs a kind; write pool:KIND, as `halfrow-station board list` names the kinds")]
    NoKind,
    /// The program that leases boards of a pool could not be started.
    #[error(
        "boards of a pool are leased by the program {STATION}, which cannot be started; it belongs beside this one: \
         cargo build --release --package {STATION}"
    )]
    NoStation(#[source] io::Error),
    /// No board of this kind is available; the station's program has said why.
    #[error("no board of the kind {kind} is available; see what {STATION} wrote to stderr")]
    None {
        /// The kind.
        kind: String,
    },
    /// The output of the station's program could not be read.
    #[error("the output of {STATION} cannot be read; install the one that belongs to this version")]
    Unread(#[source] io::Error),
    /// The station's program printed a line that this program does not understand.
    #[error("{STATION} says `{line}`, which is no message; install the one that belongs to this version")]
    Message {
        /// What it says.
        line: String,
        /// Why that is none.
        source: serde_json::Error,
    },
    /// The board's place in the pool is not a target that this program can open.
    #[error(
        "the board {board} is shared at `{target}`, which is no board; share it again with `halfrow-station board share`"
    )]
    Target {
        /// The board.
        board: String,
        /// Its place.
        target: String,
        /// Why that is none.
        source: TargetError,
    },
}

/// A leased board.
#[derive(Debug)]
struct Lent {
    kind: String,
    target: Target,
    /// Closing it returns the board. The system does so when the program ends.
    _until_closed: Option<ChildStdin>,
}

/// A message from the program that leases boards.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Message {
    Waits { before: u32, seconds: u64 },
    Held { board: String, target: String },
    Lost { said: String },
}

/// The kind of board that `target` means any one of, if it is a pool.
///
/// # Errors
/// [`PoolError::NoKind`]
pub(crate) fn kind(target: &Target) -> Result<Option<&str>, PoolError> {
    let kind = target.address.as_deref().filter(|kind| !kind.is_empty());
    if target.kind == POOL { kind.ok_or(PoolError::NoKind).map(Some) } else { Ok(None) }
}

/// The board that `target` means: itself, or one leased from the pool of its kind. The first call waits for that.
///
/// # Errors
/// [`PoolError`]
pub(crate) fn resolved(target: Target) -> Result<Target, PoolError> {
    let Some(kind) = kind(&target)?.map(str::to_owned) else { return Ok(target) };
    let mut lent = LENT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(lent) = lent.as_ref().filter(|lent| lent.kind == kind) {
        return Ok(lent.target.clone());
    }
    Ok(lent.insert(lease(kind)?).target.clone())
}

/// Whether the lease of the board was lost, so that it may be somebody else's by now. That ends the run.
#[must_use]
pub(crate) fn is_lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Waits for a board of this kind and leases it.
fn lease(kind: String) -> Result<Lent, PoolError> {
    let mut child = hold(&kind).map_err(PoolError::NoStation)?;
    let until_closed = child.stdin.take();
    let mut told = child.stdout.take().map(BufReader::new);
    match held(&kind, told.as_mut()) {
        Ok(target) => {
            watch(told, child);
            Ok(Lent { kind, target, _until_closed: until_closed })
        }
        Err(error) => {
            // It ends when nobody talks to it any more, and returns the board if it has one.
            drop((until_closed, told));
            let _ = child.wait();
            Err(error)
        }
    }
}

/// Where the board is that the program holds, as soon as it holds one of this kind.
fn held(kind: &str, mut told: Option<&mut BufReader<ChildStdout>>) -> Result<Target, PoolError> {
    let mut last = None;
    while let Some(message) = next(told.as_deref_mut())? {
        match message {
            Message::Waits { before, seconds } => {
                let is_news = last.is_none_or(|(was, at)| was != before || seconds >= at + TOLD);
                if is_news {
                    last = Some((before, seconds));
                    tell_wait(kind, before, seconds);
                }
            }
            Message::Held { board, target } => {
                console::diagnose(&format_args!("the board {board} is ours, at {target}"));
                let parsed = target.parse();
                return parsed.map_err(|source| PoolError::Target { board, target, source });
            }
            Message::Lost { .. } => break,
        }
    }
    Err(PoolError::None { kind: kind.to_owned() })
}

fn hold(kind: &str) -> io::Result<Child> {
    let arguments = ["board", "hold", "--", kind].map(OsStr::new);
    // In a process group of its own: a signal from the keyboard does not reach it, so this program keeps the board until it ends.
    let mut command = Command::new(beside::station()?);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).process_group(0).spawn()
}

fn next(told: Option<&mut BufReader<ChildStdout>>) -> Result<Option<Message>, PoolError> {
    let mut line = String::new();
    let read = match told {
        Some(told) => told.read_line(&mut line).map_err(PoolError::Unread)?,
        None => 0,
    };
    if read == 0 {
        return Ok(None);
    }
    let message = serde_json::from_str(&line);
    message.map(Some).map_err(|source| PoolError::Message { line: line.trim().to_owned(), source })
}

fn tell_wait(kind: &str, before: u32, seconds: u64) {
    let place = match before {
        0 => "the next one is ours".to_owned(),
        before => format!("{before} in front"),
    };
    console::diagnose(&format_args!("waiting for a board of the kind {kind}: {place}, {seconds} s"));
}

/// Notes when the board is lost: by a message, or because the program that holds it has ended.
fn watch(mut told: Option<BufReader<ChildStdout>>, mut child: Child) {
    let watched = thread::Builder::new().name("pool".to_owned()).spawn(move || {
        let said = match next(told.as_mut()) {
            Ok(Some(Message::Lost { said })) => said,
            Ok(_) => format!("{STATION}, which held the board, has ended"),
            Err(error) => error.to_string(),
        };
        LOST.store(true, Ordering::Relaxed);
        console::error(&said);
        let _ = child.wait();
    });
    if watched.is_err() {
        LOST.store(true, Ordering::Relaxed);
    }
}
