//! A board that is about to be opened: its link, and the way back to it.

use std::error::Error;
use std::fmt;

use super::Link;
use crate::target::BoardKind;

/// Opens the link to a board again after an outage. Called repeatedly until it succeeds; the earlier link is closed by then.
pub type Reopener = Box<dyn FnMut() -> Result<Box<dyn Link>, Box<dyn Error + Send + Sync>> + Send>;

/// A board that is about to be opened. [`open`](crate::open) makes one of a target; a program with a link of its own
/// makes one itself.
pub struct Candidate {
    /// The board's name in results and logs: the target string, if it has a target.
    pub target: String,
    /// The kind of board that the target promises. A link that leaves this process may still lead to a mock; then the board says
    /// so.
    pub kind: BoardKind,
    /// The link to it.
    pub link: Box<dyn Link>,
    /// How to open the link again after the board went away. If none, an outage ends the run.
    pub reopen: Option<Reopener>,
}

impl Candidate {
    /// A board of `kind` behind `link`, called `target`. Its link cannot be opened again.
    #[must_use]
    pub fn new(target: impl Into<String>, kind: BoardKind, link: impl Link + 'static) -> Self {
        Self { target: target.into(), kind, link: Box::new(link), reopen: None }
    }

    /// The same, but `reopen` opens the link again.
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
