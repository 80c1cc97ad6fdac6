//! Clients that ask every few seconds take turns with each other, and are answered soon: a plant that hangs holds up one
//! thread, but neither the pages nor the answer that says so.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::Mutex;
use tokio::time;

use crate::history::counts::Tally;
use crate::history::paced::Paced;
use crate::said::Said;
use crate::store::{Snapshot, StoreError};
use crate::web::state::App;
use crate::web::visit::Visit;

/// How long an answer may take. Prometheus waits for ten seconds.
const PATIENCE: Duration = Duration::from_secs(5);

/// What was counted before, and whose turn it is.
#[derive(Debug)]
pub(in crate::web) struct Turns {
    pub(super) tally: Tally,
    /// How many jobs of a plant wait for a person.
    pub(super) dead_jobs: Paced<u32>,
    turn: Arc<Mutex<()>>,
}

impl Turns {
    /// Nothing is counted yet. With `by_lane` the lanes of a station are told apart. After each count there is a pause of `rests`
    /// times as long as that took, a minute at most.
    pub(in crate::web) fn new(by_lane: bool, rests: u32) -> Self {
        Self { tally: Tally::new(by_lane, rests), dead_jobs: Paced::new(rests), turn: Arc::default() }
    }
}

/// What `count` finds in the store as it is at one moment; none when it cannot be read, or not soon enough.
pub(super) async fn counted<T: Send + 'static>(
    app: &App,
    visit: &Visit,
    count: impl FnOnce(&Snapshot, &Turns) -> Result<T, StoreError> + Send + 'static,
) -> Option<T> {
    let of = app.clone();
    let found = time::timeout(PATIENCE, async {
        let turn = Arc::clone(&app.turns().turn).lock_owned().await;
        let look = move |now: &Snapshot| {
            // The turn ends with the look, however long that takes.
            let _turn = turn;
            count(now, of.turns())
        };
        app.try_to_look(visit, look).await
    });
    match found.await {
        Ok(Ok(Ok(found))) => return Some(found),
        Ok(Ok(Err(error))) => {
            tracing::warn!("what is counted cannot be told: {}", Said::of(&error).with_codes());
        }
        // The error is in the log already.
        Ok(Err(_)) => {}
        Err(_) => tracing::warn!("what is counted was not read within {} s", PATIENCE.as_secs()),
    }
    None
}
