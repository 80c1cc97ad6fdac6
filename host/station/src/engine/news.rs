//! What the engine reports to its listeners: the state of every lane, what became of each scan, hooks that failed.

use std::sync::mpsc::{self, Receiver, SyncSender, TrySendError};

use serde::Serialize;

use crate::floor::{Act, Lane, Shown, Word};
use crate::lane::Doing;
use crate::said::{self, Said};

/// How many pieces of news a listener may be behind. One that is further behind hears no more, and has to begin anew.
const BACKLOG: usize = 1024;

/// A piece of news.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "news", rename_all = "kebab-case")]
pub enum News {
    /// The state of a lane.
    Lane(LaneState),
    /// What a lane's run does.
    Doing(LaneDoing),
    /// What became of a scan.
    Scan(Became),
    /// A hook did not do what it should have done. The verdict stands.
    Hook(FailedHook),
}

/// What a lane's run does.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LaneDoing {
    /// The lane.
    pub lane: String,
    /// The run.
    pub run: String,
    /// What.
    #[serde(flatten)]
    pub what: Doing,
}

/// The result of a scan or of an act.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Became {
    /// The number that it came with.
    pub number: u64,
    /// What was scanned.
    pub scanned: String,
    /// Whether it was taken.
    pub is_taken: bool,
    /// The lane that it went to.
    pub lane: Option<String>,
    /// What was understood, or why it was refused.
    #[serde(serialize_with = "said::as_text")]
    pub said: Said,
}

/// A hook that failed, and the unit that it was for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FailedHook {
    /// The lane.
    pub lane: String,
    /// The run; `None` when the hook should have shown that there is no verdict any more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// The serial number of that run's unit, which may have left the lane since.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub serial: Option<String>,
    /// What went wrong.
    #[serde(serialize_with = "said::as_text")]
    pub said: Said,
}

/// The state of a lane.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LaneState {
    /// Its name.
    pub lane: String,
    /// Its state.
    pub state: Word,
    /// Whether a board is in it.
    pub is_present: bool,
    /// The serial number that it tests, that waits, or whose verdict is shown.
    pub serial: Option<String>,
    /// The run that is under way, or not saved.
    pub run: Option<String>,
    /// The last verdict, which is saved.
    pub shown: Option<Shown>,
    /// The verdict of the board before, where another one was plugged in since, or that on the mock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last: Option<Shown>,
    /// Why it is out of service, what it is to test first, why nothing was saved, or why no run was begun.
    #[serde(serialize_with = "said::as_text_if_any")]
    pub note: Option<Said>,
    /// Why its last scan came to nothing, where the note says what it is to test first.
    #[serde(serialize_with = "said::as_text_if_any", skip_serializing_if = "Option::is_none")]
    pub refused: Option<Said>,
    /// Whether its result is saved, but not yet at the plant, which must have it.
    #[serde(skip)]
    pub awaits_plant: bool,
    /// What a button can do with it now.
    #[serde(skip)]
    pub can: Vec<Act>,
}

impl From<&Lane> for LaneState {
    fn from(lane: &Lane) -> Self {
        Self {
            lane: lane.name().to_owned(),
            state: lane.word(),
            is_present: lane.is_present(),
            serial: lane.serial().map(str::to_owned),
            run: lane.run().map(str::to_owned),
            shown: lane.shown().cloned(),
            last: lane.last().cloned(),
            note: lane.note().cloned(),
            refused: lane.refused().cloned(),
            awaits_plant: lane.awaits_plant(),
            can: lane.can(),
        }
    }
}

/// The listeners.
#[derive(Debug, Default)]
pub(super) struct Listeners(Vec<SyncSender<News>>);

impl Listeners {
    /// Adds a listener, who hears `first` before all else.
    pub(super) fn add(&mut self, first: impl Iterator<Item = News>) -> Receiver<News> {
        let (sender, receiver) = mpsc::sync_channel(BACKLOG);
        first.for_each(|news| drop(sender.try_send(news)));
        self.0.push(sender);
        receiver
    }

    /// Sends to every listener. None is waited for: one that is too far behind is dropped.
    pub(super) fn tell(&mut self, news: &News) {
        self.0.retain(|listener| match listener.try_send(news.clone()) {
            Ok(()) => true,
            Err(TrySendError::Full(_)) => {
                tracing::warn!("a listener is {BACKLOG} pieces of news behind, and hears no more");
                false
            }
            Err(TrySendError::Disconnected(_)) => false,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::said::Saying;

    #[test]
    fn a_slow_listener_is_let_go_and_the_others_hear_everything() {
        let mut listeners = Listeners::default();
        let news = || {
            News::Hook(FailedHook {
                lane: "1".to_owned(),
                run: Some("r".to_owned()),
                serial: Some("S1".to_owned()),
                said: Saying::OutByPerson.into(),
            })
        };
        let (slow, quick) = (listeners.add(std::iter::empty()), listeners.add(std::iter::once(news())));
        quick.recv().unwrap();
        for _ in 0..=BACKLOG {
            listeners.tell(&news());
            quick.recv().unwrap();
        }
        assert_eq!(slow.iter().count(), BACKLOG);
        assert_eq!(listeners.0.len(), 1);
    }
}
