//! Boards that several computers share. Each is held by one of them, until a time by the plant's clock; whoever has waited
//! longest gets it next.

use serde::Serialize;

use super::super::database::{Database, DatabaseError, Row, values};
use super::super::{By, Deed, Snapshot, StoreError, statements as sql};
use super::{LOCK_BOARDS, Plant};
use crate::clock::Moment;
use crate::ids;

/// How long a board or a job is held without being renewed, in milliseconds.
pub(crate) const LEASE_MS: i64 = 30_000;
/// How long the place of a waiter who does not ask again is kept, in milliseconds.
const WAITING_MS: i64 = 10_000;

/// A board that several computers share.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SharedBoard {
    /// Its name.
    pub name: String,
    /// Its kind, by which those ask who will take any board.
    pub kind: String,
    /// Its target string.
    pub target: String,
    /// The product that it is a unit of; empty if no plan judges it.
    pub product: String,
    /// Its serial number; empty if no plan judges it.
    pub serial: String,
    /// The only station that reaches it; empty if all do.
    pub station: String,
    /// Why nobody may have it, if it is out.
    pub out: Option<String>,
    /// How often it was given to somebody.
    pub fence: i64,
    /// Who has it.
    pub holder: Option<String>,
    /// Until when, in milliseconds since 1970, UTC, by the plant's clock, unless it is renewed.
    pub until_ms: Option<i64>,
}

/// A board that is held.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Lease {
    /// The board.
    pub board: String,
    /// Where it is.
    pub target: String,
    /// Who has it.
    pub holder: String,
    /// How often it was given to somebody, this time included.
    pub fence: i64,
    /// A moment not later than when it was given.
    #[serde(skip)]
    pub(crate) since: Moment,
    /// The product that it is a unit of; empty if no plan judges it.
    #[serde(skip)]
    pub(crate) product: String,
    /// Its serial number; empty if no plan judges it.
    #[serde(skip)]
    pub(crate) serial: String,
}

/// Somebody who waits for any board of a kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Waiter {
    /// Their place in the queue, a UUID of version 7: whoever came first has the smaller one.
    pub id: String,
    /// The kind.
    pub kind: String,
    /// Who they are: their station, a blank, and a name without blanks.
    pub holder: String,
    /// The station that they are at.
    pub station: String,
}

/// The answer to somebody who waits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The board is theirs.
    Held(Lease),
    /// Others are in front of them.
    Waits {
        /// How many.
        before: u32,
    },
    /// There is no board of the kind, in use or not, that they could get.
    Never,
}

impl Waiter {
    /// Somebody at `station` who waits from `now_ms` on, by the plant's clock, called `name`, which has no blanks. By their own
    /// clocks, those whose is slow would come first.
    ///
    /// # Errors
    /// [`ids::NoRandomness`]
    pub fn new(kind: &str, name: &str, station: &str, now_ms: i64) -> Result<Self, ids::NoRandomness> {
        let id = ids::new(now_ms)?.to_string();
        let holder = format!("{station} {name}");
        Ok(Self { id, kind: kind.to_owned(), holder, station: station.to_owned() })
    }
}

impl Plant {
    /// Enters a board that is shared, or changes it while nobody has it; `operator` says so. Returns whether it is entered: not
    /// when somebody has it, or another one is this unit.
    ///
    /// # Errors
    /// [`StoreError`] when the plant does not take it.
    pub fn share(&mut self, board: &SharedBoard, operator: &str) -> Result<bool, StoreError> {
        let SharedBoard { name, kind, target, product, serial, station, .. } = board;
        let deed = Deed { operator, act: "share board", subject: name, detail: target };
        self.audited("to share a board", deed, |to| {
            // Two who share one unit under two names at once would not see each other's board.
            to.batch(LOCK_BOARDS)?;
            shorten(to)?;
            to.execute(sql::ADD_BOARD, values![name, kind, target, product, serial, station])
        })
    }

    /// The name of another board that is the same unit, if there is one.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub(crate) fn other_of_unit(&mut self, board: &SharedBoard) -> Result<Option<String>, StoreError> {
        let SharedBoard { name, product, serial, .. } = board;
        self.carry_out("to tell its boards", |database| {
            database.first(sql::OTHER_OF_UNIT, values![product, serial, name], |row| row.get(0))
        })
    }

    /// Takes out the board of this name: nobody gets it any more, and whoever has it loses it. Returns whether
    /// there is such a board.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn take_out(&mut self, name: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to take a board out", by.does("board out", name), |to| {
            to.execute(sql::BOARD_OUT, values![&**by.reason, name])
        })
    }

    /// Lets the board of this name be given out again. Returns whether there is such a board.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn put_in(&mut self, name: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to put a board back", by.does("board in", name), |to| {
            to.execute(sql::BOARD_OUT, values![None::<&str>, name])
        })
    }

    /// Stops sharing the board of this name. Returns whether there was such a board.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn unshare(&mut self, name: &str, by: By<'_>) -> Result<bool, StoreError> {
        self.audited("to unshare a board", by.does("unshare board", name), |to| {
            to.execute(sql::FORGET_BOARD, values![name])
        })
    }

    /// Gives `waiter` a board of the kind if it is their turn, and otherwise keeps their place for as long as they keep asking.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn wait(&mut self, waiter: &Waiter) -> Result<Turn, StoreError> {
        let Waiter { id, kind, holder, station } = waiter;
        self.change("to give a board", |to| {
            shorten(to)?;
            to.execute(sql::WAIT, values![id, kind, holder, WAITING_MS])?;
            let queue = to.all(sql::QUEUE, values![kind, id], Queue::of)?;
            let left = left_to_others(&queue, station);
            let free: Option<String> =
                to.first(sql::FREE_BOARD, values![kind, station, left], |row| row.get(0))?;
            let Some(name) = free else {
                let reachable: i64 = to.one(sql::REACHABLE, values![kind, station], |row| row.get(0))?;
                if reachable == 0 {
                    to.execute(sql::FORGET_WAITERS, values![id])?;
                    return Ok(Turn::Never);
                }
                let before: i64 = queue.iter().map(|queue| queue.waiting).sum();
                return Ok(Turn::Waits { before: u32::try_from(before).unwrap_or(u32::MAX) });
            };
            to.execute(sql::FORGET_WAITERS, values![id])?;
            Ok(Turn::Held(hold(to, &name, holder)?))
        })
    }

    /// Removes `waiter` from the queue.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn leave(&mut self, waiter: &Waiter) -> Result<(), StoreError> {
        self.carry_out("to forget who waits", |to| to.execute(sql::FORGET_WAITERS, values![&waiter.id]))
            .map(drop)
    }

    /// Renews the lease. Returns whether the board is still held.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn renew(&mut self, lease: &Lease) -> Result<bool, StoreError> {
        let Lease { board, holder, fence, .. } = lease;
        let renewed = self.carry_out("to let a board be held", |to| {
            to.execute(sql::RENEW_BOARD, values![LEASE_MS, board, holder, *fence])
        })?;
        Ok(renewed == 1)
    }

    /// Gives the board back, if it is still held.
    ///
    /// # Errors
    /// Like [`Self::share`].
    pub fn give_back(&mut self, lease: &Lease) -> Result<(), StoreError> {
        let Lease { board, holder, fence, .. } = lease;
        let back =
            |to: &mut dyn Database| to.execute(sql::RETURN_BOARD, values![board, holder, *fence]).map(drop);
        self.carry_out("to take a board back", back)
    }
}

/// Those of one station who wait in front of somebody.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Queue {
    station: String,
    waiting: i64,
    /// How many boards are free that only this station reaches.
    own: i64,
}

impl Queue {
    fn of(row: &Row<'_>) -> Result<Self, DatabaseError> {
        Ok(Self { station: row.get(0)?, waiting: row.get(1)?, own: row.get(2)? })
    }

    /// How many of them need a board that every station reaches.
    fn of_all(&self) -> i64 {
        (self.waiting - self.own).max(0)
    }
}

/// How many of the free boards that somebody at `station` reaches are left to those in front: of the station's own, to those at
/// the same station; of the rest, to all for whom no board is free that only their station reaches.
fn left_to_others(queue: &[Queue], station: &str) -> i64 {
    let (ours, others): (Vec<_>, Vec<_>) = queue.iter().partition(|queue| queue.station == station);
    let (waiting, own) = ours.first().map_or((0, 0), |ours| (ours.waiting, ours.own));
    if waiting < own { waiting } else { waiting + others.into_iter().map(Queue::of_all).sum::<i64>() }
}

/// Lets nothing end later than if it were given or asked for now. Before the plant's clock was set back it may have been; otherwise
/// whoever is gone would keep it for as long as the clock was set back.
pub(super) fn shorten(to: &mut dyn Database) -> Result<(), DatabaseError> {
    to.execute(sql::SHORTEN, values![LEASE_MS, WAITING_MS]).map(drop)
}

/// Gives the board of this name to `holder`; its row is locked.
pub(super) fn hold(to: &mut dyn Database, name: &str, holder: &str) -> Result<Lease, DatabaseError> {
    let since = Moment::now();
    to.one(sql::HOLD_BOARD, values![holder, LEASE_MS, name], |row| {
        Ok(Lease {
            board: row.get(0)?,
            target: row.get(1)?,
            holder: holder.to_owned(),
            fence: row.get(2)?,
            since,
            product: row.get(3)?,
            serial: row.get(4)?,
        })
    })
}

/// Every shared board, ordered by kind and name.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub fn boards(of: &Snapshot) -> Result<Vec<SharedBoard>, StoreError> {
    of.rows("to tell its boards", sql::BOARDS, &[], board)
}

fn board(row: &Row<'_>) -> Result<SharedBoard, DatabaseError> {
    Ok(SharedBoard {
        name: row.get(0)?,
        kind: row.get(1)?,
        target: row.get(2)?,
        product: row.get(3)?,
        serial: row.get(4)?,
        station: row.get(5)?,
        out: row.get(6)?,
        fence: row.get(7)?,
        holder: row.get(8)?,
        until_ms: row.get(9)?,
    })
}

/// Somebody in the queue of a kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Waiting {
    /// The kind.
    pub kind: String,
    /// Who.
    pub holder: String,
    /// Since when, in milliseconds since 1970, UTC, by the plant's clock.
    pub since_ms: i64,
}

/// Who waits, ordered by kind and by place in its queue.
///
/// # Errors
/// [`StoreError`] when the plant cannot be read.
pub(crate) fn waiters(of: &Snapshot) -> Result<Vec<Waiting>, StoreError> {
    of.rows("to tell who waits", sql::WAITERS, &[], |row| {
        Ok(Waiting { kind: row.get(0)?, holder: row.get(1)?, since_ms: ids::made_ms(row.text(2)?) })
    })
}
