//! The judge's progress as messages, no more of them than somebody can read.

use std::time::{Duration, Instant};

use halfrow::{Event, Progress};
use parking_lot::Mutex;

use super::Message;

/// The least time between two messages that only count rows.
const PACE: Duration = Duration::from_millis(250);

/// Sends progress as messages.
pub(super) struct ProgressMessages<'a> {
    tell: &'a (dyn Fn(&Message) + Sync),
    rows: Mutex<Rows>,
}

struct Rows {
    done: u64,
    expected: u64,
    told: Option<Instant>,
}

impl<'a> ProgressMessages<'a> {
    pub(super) fn by(tell: &'a (dyn Fn(&Message) + Sync)) -> Self {
        Self { tell, rows: Mutex::new(Rows { done: 0, expected: 0, told: None }) }
    }

    fn count(&self, rows: u64) {
        let mut so_far = self.rows.lock();
        so_far.done += rows;
        if so_far.told.is_none_or(|told| told.elapsed() >= PACE) {
            so_far.told = Some(Instant::now());
            (self.tell)(&Message::Rows { done: so_far.done, expected: so_far.expected });
        }
    }
}

impl Progress for ProgressMessages<'_> {
    fn event(&self, event: Event) {
        match event {
            Event::Step(step) => (self.tell)(&Message::Judging { step }),
            Event::Frame(name) => (self.tell)(&Message::Frame { name }),
            Event::AtSpeed(judged) => (self.tell)(&Message::AtSpeed(judged)),
            Event::Rows(rows) => self.count(rows),
            Event::RowsExpected(rows) => self.rows.lock().expected += rows,
            // No plan has a step of that kind.
            Event::Soaked(_) | Event::Done => {}
        }
    }
}
