//! What the log says of a sink: once for each reason that it takes nothing, once that it does not take all, and once that it
//! does again.

use halfrow::words::{count, verb};

use super::Undelivered;
use crate::said::Said;
use crate::store::{Backlog, Entry, Kind, SINK_OF_PLANT, StoreError};

/// The state of a sink, as far as the log has reported it.
#[derive(Clone, Debug, Default)]
pub struct Standing {
    /// The code of why it was away.
    away: Option<String>,
    /// It did not take something for a time.
    is_behind: bool,
    /// How much it did not have when that was read last.
    pub(super) left: Option<Backlog>,
}

impl Standing {
    /// Notes that the sink has not taken this.
    pub(super) fn refused(&mut self, sink: &str, entry: &Entry, why: &Undelivered) {
        match why {
            Undelivered::Away(said) => self.away(sink, said),
            Undelivered::NotNow(said) | Undelivered::Early(said) if !self.is_behind => {
                self.is_behind = true;
                tracing::warn!(
                    "{} does not take {} for now: {}",
                    called(sink),
                    named(entry),
                    said.with_codes()
                );
            }
            Undelivered::NotNow(_) | Undelivered::Early(_) => {}
            Undelivered::Refused(said) => {
                tracing::warn!(
                    "{} refuses {}, which waits for a person: {}",
                    called(sink),
                    named(entry),
                    said.with_codes()
                );
            }
        }
    }

    /// Notes that the sink is not there.
    pub(super) fn away(&mut self, sink: &str, said: &Said) {
        // A plant that is put back is unreachable first, and only what it says later calls for a person.
        if self.away.as_ref() != Some(&said.code) {
            self.away = Some(said.code.clone());
            tracing::warn!("{} takes nothing, and all waits for it: {}", called(sink), said.with_codes());
        }
    }

    /// Notes that the sink is there, and has taken `sent` more; `left` finds out what it does not have.
    // The end of an outage is a warning, too, so that a log of only warnings has both its beginning and its end.
    pub(super) fn there(
        &mut self,
        sink: &str,
        sent: usize,
        left: impl FnOnce() -> Result<Backlog, StoreError>,
    ) {
        if self.away.is_none() && !self.is_behind {
            return;
        }
        // If that cannot be read now, it is tried after the next entry.
        let Ok(Backlog { entries, dead, was_tried, .. }) = left() else { return };
        if self.away.take().is_some() {
            let waited = u64::from(entries - dead) + sent as u64;
            tracing::warn!("{} answers again: {waited} waited", called(sink));
        }
        if self.is_behind && !was_tried {
            self.is_behind = false;
            let sink = called(sink);
            match dead {
                0 => tracing::warn!("{sink} has taken all that it did not take before"),
                _ => tracing::warn!("nothing waits for {sink} any more, but {} for a person", waiting(dead)),
            }
        }
    }
}

fn waiting(entries: u32) -> String {
    format!("{} {}", count(entries, "entry"), verb(entries, "wait"))
}

/// What people call a sink.
fn called(sink: &str) -> String {
    if sink == SINK_OF_PLANT { "the plant".to_owned() } else { format!("the sink {sink}") }
}

/// What people call an entry.
fn named(Entry { kind, subject, .. }: &Entry) -> String {
    match kind {
        Kind::Run => format!("the run {subject}"),
        Kind::Waiver => format!("the waiver {subject}"),
        Kind::Audit => format!("the line {subject} of the audit"),
    }
}
