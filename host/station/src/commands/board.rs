//! `halfrow-station board`

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use halfrow::link;
use halfrow::link::kinds::{self, Place};
use halfrow::target::Target;
use rand::{RngExt as _, rng};
use serde_json::json;

use super::beginning::{SettingsFile, Signal, plant};
use super::looking::{either, table, time};
use super::why::{Why, at_plant, name, person};
use super::{Failure, print, tell};
use crate::console;
use crate::exit::Exit;
use crate::history::stations::stations;
use crate::said::Said;
use crate::settings::moving;
use crate::store::{Plant, PlantAddress, PlantLink, SharedBoard, StoreError, Turn, Waiter, boards};
use crate::trust::is_near;
use crate::work::{Held, Holding, sleep_unless};

/// How often a waiting caller asks again.
const ASKED: Duration = Duration::from_secs(1);
/// How often to check whether anything happened.
const LOOK: Duration = Duration::from_millis(50);

/// Share boards among several computers: each is used by one at a time
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Share a board, or change where it is while nobody has it
    Share(Share),
    /// Print the boards, and who has them
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Take a board out of use; whoever has it loses it
    Out(Change),
    /// Put a board back into use
    In(Change),
    /// Stop sharing a board
    Unshare(Change),
    /// Wait for a board of a kind, and hold it until the end of stdin
    ///
    /// Prints one JSON object per line: "waits" with how many are in front and how many seconds it has waited, "held" with
    /// the board, and "lost" with the reason, after which it ends.
    Hold {
        /// The kind
        kind: String,
    },
}

#[derive(Debug, Args)]
struct Share {
    /// Its name
    #[arg(value_parser = name)]
    name: String,
    /// Its kind: whoever needs any board asks for a kind
    #[arg(long, value_parser = name)]
    kind: String,
    /// Where it is, as `halfrow boards` names it
    #[arg(long, value_name = "TARGET")]
    board: Target,
    /// The product that it is a unit of, for jobs
    #[arg(long, requires = "serial", value_parser = name)]
    product: Option<String>,
    /// Its serial number, for jobs
    #[arg(long, requires = "product", value_parser = name)]
    serial: Option<String>,
    /// The one station that reaches it [default: every one does]
    #[arg(long, value_name = "NAME", value_parser = name)]
    station: Option<String>,
    /// Your name, which the audit keeps
    #[arg(long, value_name = "NAME", value_parser = person)]
    operator: String,
}

#[derive(Debug, Args)]
struct Change {
    /// The board
    name: String,
    #[command(flatten)]
    why: Why,
}

/// The plant does not have the board, or somebody is using it.
#[derive(Debug, thiserror::Error)]
#[error(
    "there is no board {name} that could be {done}; `halfrow-station board list` tells which there are, and who has them"
)]
pub(super) struct NoBoard {
    pub(super) name: String,
    done: &'static str,
}

/// The unit is already shared under another name.
#[derive(Debug, thiserror::Error)]
#[error(
    "{serial} is shared as the board {board} already, and would be given to two; unshare that one first by `halfrow-station board unshare {board}`"
)]
pub(super) struct SharedAlready {
    pub(super) serial: String,
    pub(super) board: String,
}

/// The text does not name a place where a board can be, such as a serial port or an address.
#[derive(Debug, thiserror::Error)]
#[error("`{kind}` is not a kind of board; write one as `halfrow boards` lists them")]
pub(super) struct NoBoardKind {
    pub(super) kind: String,
}

/// A place that may be another board than the one that is shared.
#[derive(Debug, thiserror::Error)]
pub(super) enum OtherPlace {
    /// The place of the shared board is another board when boards are plugged in in another order.
    #[error("{what}; {remedy}")]
    Moves {
        /// What is wrong with it.
        what: String,
        /// What to write instead.
        remedy: String,
    },
    /// The place of the shared board is one of this computer's own. At every other one it is another board, or none.
    #[error(
        "`{board}` is another board at every computer; name the one station that reaches it by --station"
    )]
    Local {
        /// The place.
        board: String,
    },
}

/// No shared board is of this kind.
#[derive(Debug, thiserror::Error)]
#[error(
    "no board of the kind {kind} is shared with this station; `halfrow-station board list` tells which are"
)]
pub(super) struct NoKind {
    pub(super) kind: String,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_without_lanes()?;
    let address = plant(&settings)?.address()?;
    match what {
        Action::Share(share) => {
            if kinds::of(&share.board).is_none() {
                return Err(Failure::call(NoBoardKind { kind: share.board.kind.clone() }));
            }
            link::check(&share.board).map_err(Failure::call)?;
            share.refuse_other_place().map_err(Failure::call)?;
            if let Some(station) = &share.station {
                warn_of_no_station(&address, station)?;
            }
            shared(&mut at_plant(&address, &share.operator, &format!("board share {}", share.name))?, share)
        }
        Action::List { json } => {
            let found = PlantLink::new(address).look(boards)?;
            either(&found, *json, |found| text(found))
        }
        Action::Out(Change { name, why }) => {
            let mut plant = at_plant(&address, &why.operator, &format!("board out {name}"))?;
            changed(plant.take_out(name, why.by())?, name, "out")
        }
        Action::In(Change { name, why }) => {
            let mut plant = at_plant(&address, &why.operator, &format!("board in {name}"))?;
            changed(plant.put_in(name, why.by())?, name, "in")
        }
        Action::Unshare(Change { name, why }) => {
            let mut plant = at_plant(&address, &why.operator, &format!("board unshare {name}"))?;
            changed(plant.unshare(name, why.by())?, name, "unshared")
        }
        Action::Hold { kind } => hold(&address, kind, &settings.name),
    }
}

impl Share {
    /// Refuses a place that whoever has the board may find another board at.
    fn refuse_other_place(&self) -> Result<(), OtherPlace> {
        let Self { board, station, .. } = self;
        if station.is_none() && is_own(board) {
            return Err(OtherPlace::Local { board: board.to_string() });
        }
        match moving(board) {
            Some((what, remedy)) => Err(OtherPlace::Moves { what, remedy }),
            None => Ok(()),
        }
    }

    fn board(&self) -> SharedBoard {
        let text = |given: &Option<String>| given.clone().unwrap_or_default();
        SharedBoard {
            name: self.name.clone(),
            kind: self.kind.clone(),
            target: self.board.to_string(),
            product: text(&self.product),
            serial: text(&self.serial),
            station: text(&self.station),
            out: None,
            fence: 0,
            holder: None,
            until_ms: None,
        }
    }
}

/// Whether every computer has a place of this name.
fn is_own(board: &Target) -> bool {
    match kinds::place_of(board) {
        Some(Place::Chip | Place::Port) => true,
        Some(Place::Host) => {
            let at = board.address.as_ref().and_then(|address| address.rsplit_once(':'));
            at.is_some_and(|(host, _)| is_near(host))
        }
        Some(Place::Program) | None => false,
    }
}

/// Warns of a board that nobody reaches.
fn warn_of_no_station(address: &PlantAddress, name: &str) -> Result<(), Failure> {
    let found = PlantLink::new(address.clone()).look(stations)?;
    if !found.iter().any(|station| station.name == name) {
        console::diagnose(&format_args!(
            "warning: no station {name} was ever heard from; nobody gets the board before one is: the plant's first page \
             lists those that were"
        ));
    }
    Ok(())
}

/// Shares a board, or says as which other board this unit is shared already.
fn shared(plant: &mut Plant, share: &Share) -> Result<Exit, Failure> {
    let board = share.board();
    let is_shared = plant.share(&board, &share.operator)?;
    if !is_shared && let Some(other) = plant.other_of_unit(&board)? {
        return Err(Failure::call(SharedAlready { serial: board.serial, board: other }));
    }
    changed(is_shared, &board.name, "shared")
}

fn changed(is_changed: bool, name: &str, done: &'static str) -> Result<Exit, Failure> {
    if is_changed {
        return Ok(tell(&format!("{name} is {done}")));
    }
    Err(Failure::call(NoBoard { name: name.to_owned(), done }))
}

fn text(boards: &[SharedBoard]) -> String {
    if boards.is_empty() {
        return "no board is shared; `halfrow-station board share` shares one".to_owned();
    }
    let row = |board: &SharedBoard| {
        let state = match (&board.out, &board.holder) {
            (Some(why), _) => format!("out: {why}"),
            (None, Some(holder)) => format!("{holder}, until {}", time(board.until_ms.unwrap_or_default())),
            (None, None) => "free".to_owned(),
        };
        let SharedBoard { name, kind, target, serial, station, .. } = board.clone();
        vec![name, kind, target, serial, station, state]
    };
    table(&["board", "kind", "where", "serial", "station", "state"], &[], boards.iter().map(row))
}

/// Waits for a board of the kind, and holds it until stdin ends, a signal comes, or it is lost.
fn hold(address: &PlantAddress, kind: &str, station: &str) -> Result<Exit, Failure> {
    let signal = Signal::heed()?;
    let over = end_of_stdin()?;
    let is_over = || over.load(Ordering::Relaxed) || signal.by().is_some();
    let name = format!("{:016x}", rng().random::<u64>());
    let plant = PlantLink::new(address.clone());
    let now_ms = plant.ask(Plant::now_ms)?;
    let waiter = Waiter::new(kind, &name, station, now_ms).map_err(Failure::error)?;
    let Some(held) = wait(&plant, &waiter, &is_over)? else { return Ok(Exit::Pass) };
    let holding = Holding::begin(plant, Held::Board(held.clone()));
    print(&json!({ "held": held }).to_string())?;
    while !is_over() {
        if let Some(lost) = holding.lost() {
            print(&json!({ "lost": { "board": held.board, "said": lost.to_string() } }).to_string())?;
            return Err(Failure::error(lost));
        }
        thread::sleep(LOOK);
    }
    holding.end();
    Ok(Exit::Pass)
}

/// Waits for a turn, and prints how many are in front. `None` if the wait is over without one. A plant that has answered once is
/// asked again when it is away.
fn wait(
    plant: &PlantLink,
    waiter: &Waiter,
    is_over: &dyn Fn() -> bool,
) -> Result<Option<crate::store::Lease>, Failure> {
    let (begun, mut is_heard) = (Instant::now(), false);
    loop {
        match plant.ask(|plant| plant.wait(waiter)) {
            Ok(Turn::Held(lease)) => return Ok(Some(lease)),
            Ok(Turn::Never) => return Err(Failure::call(NoKind { kind: waiter.kind.clone() })),
            Ok(Turn::Waits { before }) => {
                is_heard = true;
                let waits = json!({ "before": before, "seconds": begun.elapsed().as_secs() });
                print(&json!({ "waits": waits }).to_string())?;
            }
            Err(error) if is_heard && error.may_pass() => {
                console::error(&format_args!("the plant is asked again: {}", Said::of(&error)));
            }
            Err(error) => return Err(error.into()),
        }
        sleep_unless(ASKED, is_over);
        if is_over() {
            left(plant, waiter);
            return Ok(None);
        }
    }
}

/// Leaves the queue. A waiter that no longer asks is dropped anyway.
fn left(plant: &PlantLink, waiter: &Waiter) {
    if let Err(StoreError::Plant { source, .. }) = plant.ask(|plant| plant.leave(waiter)) {
        console::error(&format_args!("the place in the queue is forgotten in some seconds: {source}"));
    }
}

/// A flag that becomes true when stdin ends.
fn end_of_stdin() -> Result<Arc<AtomicBool>, Failure> {
    let over = Arc::new(AtomicBool::new(false));
    let noted = Arc::clone(&over);
    let read = move || {
        let _ = io::copy(&mut io::stdin(), &mut io::sink());
        noted.store(true, Ordering::Relaxed);
    };
    thread::Builder::new().name("stdin".to_owned()).spawn(read).map_err(Failure::error)?;
    Ok(over)
}
