//! A board that is about to be opened: its link, and the way back to it.

use std::error::Error;
use std::fmt;

use super::Link;
use crate::target::BoardKind;

/// Opens the link to a board once more: called after an outage, as often as it fails. What it had before is closed by then.
pub type Reopener = Box<dyn FnMut() -> Result<Box<dyn Link>, Box<dyn Error + Send + Sync>> + Send>;

/// A board that is about to be opened. [`open`](crate::open) makes one of a target; a program with a link of its own
/// makes one itself.
pub struct Candidate {
    /// What the board is called in results and logs: the target string, for one that has a target.
    pub target: String,
    /// What the target's kind says that it is. A link to the outside may still lead to a mock, and then the board says so.
    pub kind: BoardKind,
    /// The link to it.
    pub link: Box<dyn Link>,
    /// How to open the link again when the board went away; none if it cannot be, and then an outage ends the run.
    pub reopen: Option<Reopener>,
}

impl Candidate {
    /// A board of `kind` behind `link`, called `target`, that cannot be opened again.
    #[must_use]
    pub fn new(target: impl Into<String>, kind: BoardKind, link: impl Link + 'static) -> Self {
        Self { target: target.into(), kind, link: Box::new(link), reopen: None }
    }

    /// The same, to be opened again by `reopen`.
    #[must_use]
    pub fn reopened_by<L, E, F>(self, mut reopen: F) -> Self
    where
        L: Link + 'static,
        E: Into<Box<dyn Error + Send + Sync>>,
        F: FnMut() -> Result<L, E> + Send + 'static,
    {
        let reopen: Reopener = Box::new(move || match reopen() {
            Ok(link) => Ok(Box::new(link)),
            Err(error) => Err(error.into()),
        });
        Self { reopen: Some(reopen), ..self }
    }
}

impl fmt::Debug for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { target, kind, link, reopen } = self;
        f.debug_struct("Candidate")
            .field("target", target)
            .field("kind", kind)
            .field("link", &link.name())
            .field("can_be_reopened", &reopen.is_some())
            .finish()
    }
}
