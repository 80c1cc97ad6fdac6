//! Boards that labgrid shares out in a laboratory: a lane has one for the time of a run.
//!
//! ```text
//!  run ── stdin, open while it lasts ──► halfrow-labgrid ── acquire, release ──► labgrid's coordinator
//!      ◄── the port, or why there is none ──┘ (python/halfrow-labgrid)
//! ```
//!
//! A place is given back however the station ends, because its pipe ends with it. labgrid's lock is a courtesy towards
//! people; what keeps two hosts off one board is the board's own session.

mod error;
mod held;

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use halfrow::target::Target;
use parking_lot::Mutex;

pub use error::LabgridError;
pub use held::AcquiredPlace;

use crate::presence::{self, PORTS, USB};
use crate::process_group::command;
use crate::said::Said;

/// The kind of such a board in the settings.
pub const KIND: &str = "labgrid";
/// The program that reaches labgrid.
pub const PROGRAM: &str = "halfrow-labgrid";

/// `[labgrid]`
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Labgrid {
    /// The program that reaches labgrid.
    pub program: PathBuf,
    /// Host and port of the coordinator; `None` for those that labgrid itself uses.
    pub coordinator: Option<String>,
    /// How long a place may take to be acquired or given back.
    pub deadline: Duration,
}

/// The board of a lane.
#[derive(Clone, Debug)]
pub enum LaneBoard {
    /// One that this computer reaches by itself.
    Own(Target),
    /// One that labgrid lends.
    Lent(Place),
}

impl LaneBoard {
    /// Whether both are the same board, as far as their names and what is plugged in say.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Own(one), Self::Own(other)) => {
                presence::is_same(one, other, Path::new(USB), Path::new(PORTS))
            }
            (Self::Lent(one), Self::Lent(other)) => one.name == other.name,
            _ => false,
        }
    }

    /// Whether something is plugged in at the board's place; a lent board is always there.
    pub(crate) fn is_there(&self, devices: &Path) -> bool {
        match self {
            Self::Own(target) => presence::is_there(target, devices),
            Self::Lent(_) => true,
        }
    }

    /// Whether it may be absent: a lane notices when such a board comes.
    pub(crate) fn is_pluggable(&self) -> bool {
        matches!(self, Self::Own(target) if presence::is_pluggable(target))
    }
}

impl fmt::Display for LaneBoard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Own(target) => target.fmt(f),
            Self::Lent(place) => write!(f, "{KIND}:{}", place.name),
        }
    }
}

/// One of labgrid's places, whose board one run at a time has.
#[derive(Clone, Debug)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Who has it: labgrid shows this after this computer's name.
    user: String,
    labgrid: Labgrid,
    /// The thread that still waits for it to be given back.
    leaving: Arc<Mutex<Option<JoinHandle<()>>>>,
}

impl Place {
    /// The place `name` for this lane of the station, through `labgrid`.
    #[must_use]
    pub fn new(name: String, station: &str, lane: &str, labgrid: Labgrid) -> Self {
        // labgrid splits users' names at slashes. The dot, which neither name keeps, tells where the lane's begins.
        let plain = |name: &str| name.replace(|one: char| !one.is_ascii_alphanumeric(), "-");
        let user = format!("halfrow-{}.{}", plain(station), plain(lane));
        Self { name, user, labgrid, leaving: Arc::default() }
    }

    /// A command that runs the program that reaches labgrid.
    fn call(&self, act: &str) -> Command {
        let mut call = command(&self.labgrid.program);
        call.args([act, "--place", &self.name, "--user", &self.user]);
        if let Some(coordinator) = &self.labgrid.coordinator {
            call.args(["--coordinator", coordinator]);
        }
        call
    }
}

fn places<'a>(boards: impl Iterator<Item = &'a LaneBoard>) -> impl Iterator<Item = &'a Place> {
    boards.filter_map(|board| match board {
        LaneBoard::Lent(place) => Some(place),
        LaneBoard::Own(_) => None,
    })
}

/// Waits until what the last runs of these lanes had is given back, because whoever started the station may kill all
/// that it leaves behind.
pub(crate) fn wait_until_left<'a>(boards: impl Iterator<Item = &'a LaneBoard>) {
    places(boards).for_each(Place::wait_until_left);
}

/// Gives back what an earlier station of these lanes left acquired, all places at once. A failure is logged; the next
/// run in that place reports it, too.
pub fn give_back<'a>(boards: impl Iterator<Item = &'a LaneBoard>) {
    thread::scope(|scope| {
        places(boards).for_each(|place| {
            scope.spawn(|| {
                if let Err(error) = place.free() {
                    tracing::warn!("{}: {}", place.name, Said::of(&error).with_codes());
                }
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// labgrid splits a user's name at its slash, and shows the part before it as the computer.
    #[test]
    fn the_name_under_which_a_place_is_had_holds_nothing_that_labgrid_reads_otherwise() {
        let labgrid =
            Labgrid { program: PROGRAM.into(), coordinator: None, deadline: Duration::from_secs(30) };
        let call = Place::new("cam-1".to_owned(), "Linie 4/Prüfplatz", "1", labgrid).call("hold");
        let arguments: Vec<_> = call.get_args().map(|word| word.to_string_lossy()).collect();
        assert_eq!(arguments, ["hold", "--place", "cam-1", "--user", "halfrow-Linie-4-Pr-fplatz.1"]);
    }
}
