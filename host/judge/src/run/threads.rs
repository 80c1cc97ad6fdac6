//! Threads that compute ahead of a board.

use std::io;
use std::thread::{Builder, Scope};

/// The system gives this program no thread in which to compute what must come back.
#[derive(Debug, thiserror::Error)]
#[error(
    "this computer has no thread left to compute what must come back; end other programs, or allow this user more \
     processes, then run again"
)]
pub(crate) struct NoThread(#[source] io::Error);

/// Does `work` on a thread of `scope`.
pub(super) fn spawn<'scope>(
    scope: &'scope Scope<'scope, '_>,
    work: impl FnOnce() + Send + 'scope,
) -> Result<(), NoThread> {
    let spawned = Builder::new().name("ahead".to_owned()).spawn_scoped(scope, work);
    spawned.map(drop).map_err(NoThread)
}
