//! The boards of the clients, reduced to who has them: each numbers its sessions, and with fences serves only the last one.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::Mutex;

use super::lock;

/// All boards.
pub(super) struct Shelf {
    sessions: Mutex<HashMap<String, u32>>,
    /// Runs that were judged although another run had begun on their board meanwhile.
    at_once: Mutex<Vec<String>>,
    is_fenced: bool,
}

/// Another session has begun on the board.
#[derive(Debug)]
pub(super) struct Superseded;

/// A session of a board.
pub(super) struct Session<'a> {
    shelf: &'a Shelf,
    board: String,
    number: u32,
    /// Whether it went on after another one had begun.
    is_beside: Cell<bool>,
}

impl Shelf {
    pub(super) fn new(is_fenced: bool) -> Self {
        Self { sessions: Mutex::default(), at_once: Mutex::default(), is_fenced }
    }

    /// Begins a session, which ends the one before.
    pub(super) fn begin(&self, board: &str) -> Session<'_> {
        let mut sessions = lock(&self.sessions);
        let number = sessions.entry(board.to_owned()).or_default();
        *number += 1;
        Session { shelf: self, board: board.to_owned(), number: *number, is_beside: Cell::new(false) }
    }

    /// How many runs were judged although another run had begun on their board meanwhile.
    pub(super) fn at_once(&self) -> usize {
        lock(&self.at_once).len()
    }
}

impl Session<'_> {
    fn is_last(&self) -> bool {
        lock(&self.shelf.sessions).get(&self.board) == Some(&self.number)
    }

    /// Exchanges something with the board.
    pub(super) fn exchange(&self) -> Result<(), Superseded> {
        let is_last = self.is_last();
        if self.shelf.is_fenced && !is_last {
            return Err(Superseded);
        }
        self.is_beside.set(self.is_beside.get() || !is_last);
        Ok(())
    }

    /// Records that the run of this session was judged. A session that begins after the last exchange does not matter.
    pub(super) fn judged(&self, run: &str) {
        if self.is_beside.get() {
            lock(&self.shelf.at_once).push(run.to_owned());
        }
    }
}
