//! What the log says of a lane, and what is counted: once that it begins no run or shows no verdict, and once that it does
//! again.

use std::sync::{Mutex, PoisonError};

use crate::floor::Event;
use crate::said::Said;

/// Why the station itself begins no run, as it is counted, with the codes that say so.
const REASONS: [(&str, &[&str]); 4] = [
    ("clock", &["clocks-apart", "last-run-dated-ahead"]),
    ("plan", &["plan-file-other"]),
    ("plant", &["outbox-too-full"]),
    ("other", &["thread-missing", "no-randomness", "settings-without-lane-or-plan"]),
];

/// The reason of all others: the disk is full, or the database is not what it was.
pub(super) const STORE: &str = "store";

/// The codes of reasons that are about one unit, and about nothing at the station.
const OF_UNITS: [&str; 10] = [
    "unit-passed-already",
    "unit-passed-already-asks",
    "unit-being-judged",
    "serial-empty",
    "serial-too-long",
    "serial-character-wrong",
    "serial-with-blank",
    "serial-of-no-product",
    "serial-reserved",
    "serial-check-digit-wrong",
];

/// Every reason that is counted.
pub(super) fn reasons() -> impl Iterator<Item = &'static str> {
    REASONS.iter().map(|(reason, _)| *reason).chain([STORE])
}

/// Why no run was begun, unless that is about one unit.
fn reason(why: &Said) -> Option<&'static str> {
    if has_any(why, &OF_UNITS) {
        return None;
    }
    let named = REASONS.iter().find(|(_, codes)| has_any(why, codes));
    Some(named.map_or(STORE, |(reason, _)| *reason))
}

fn has_any(said: &Said, codes: &[&str]) -> bool {
    codes.contains(&said.code.as_str()) || said.causes.iter().any(|cause| has_any(cause, codes))
}

/// The state of a lane, as far as the log has reported it.
#[derive(Clone, Copy, Debug, Default)]
struct Logged {
    /// Why it begins no run.
    refused: Option<&'static str>,
    /// It shows no verdict on a board that was judged.
    is_unsaved: bool,
}

impl Logged {
    /// Takes what happened to the lane `name`; returns what the log says of it.
    // The end of a trouble is a warning, too, so that a log of only warnings has both its beginning and its end.
    fn take(&mut self, name: &str, event: &Event) -> Option<String> {
        match event {
            Event::NotBegun { why } => {
                let now = reason(why)?;
                let is_new = self.refused.replace(now) != Some(now);
                is_new.then(|| format!("lane {name} begins no run: {why}"))
            }
            Event::Begun { .. } => self.refused.take().map(|_| format!("lane {name} begins runs again")),
            Event::Unsaved { why } | Event::NotAtPlant { why } => {
                let was_unsaved = std::mem::replace(&mut self.is_unsaved, true);
                (!was_unsaved).then(|| format!("lane {name} shows no verdict on its board: {why}"))
            }
            Event::Ended(_) => {
                let was_unsaved = std::mem::take(&mut self.is_unsaved);
                was_unsaved.then(|| format!("lane {name} shows the verdict on its board now"))
            }
            _ => None,
        }
    }
}

/// The state of every lane, as far as the log has reported it.
#[derive(Debug)]
pub(super) struct LoggedOfLanes(Mutex<Vec<Logged>>);

impl LoggedOfLanes {
    /// Of so many lanes, of which nothing was reported.
    pub(super) fn of(lanes: usize) -> Self {
        Self(Mutex::new(vec![Logged::default(); lanes]))
    }

    /// Logs what happened to the lane `name`, at this index, if it is news; returns why no run was begun, if that is
    /// the station's doing.
    pub(super) fn note(&self, lane: usize, name: &str, event: &Event) -> Option<&'static str> {
        let mut logged = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(line) = logged.get_mut(lane)?.take(name, event) {
            tracing::warn!("{line}");
        }
        match event {
            Event::NotBegun { why } => reason(why),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::RunError;
    use crate::said::Saying;
    use crate::store::{AgainError, StoreError};

    fn not_begun(error: StoreError) -> Event {
        Event::NotBegun { why: Said::of(&RunError::NotBegun(Box::new(error))) }
    }

    #[test]
    fn every_code_that_decides_what_is_counted_exists() {
        let known = crate::codes::all();
        for code in REASONS.iter().flat_map(|(_, codes)| *codes).chain(&OF_UNITS) {
            assert!(known.contains(&(*code).into()), "{code}");
        }
    }

    #[test]
    fn the_log_says_once_why_a_lane_begins_no_run_and_once_that_it_does_again() {
        let (mut lane, apart) = (Logged::default(), || not_begun(StoreError::ClockApart { minutes: 7 }));
        let begun = || Event::Begun { run: "r".to_owned() };
        let mut says = |event: &Event| lane.take("2", event).unwrap_or_default();
        assert_eq!(says(&begun()), "");
        assert!(says(&apart()).starts_with("lane 2 begins no run: the run was not begun"));
        assert_eq!(says(&apart()), "");
        let full = Event::NotBegun { why: Saying::DiskTooFull { percent: 99 }.into() };
        assert!(says(&full).contains("99 % full"), "another reason");
        assert_eq!((says(&begun()), says(&begun())), ("lane 2 begins runs again".to_owned(), String::new()));
        let passed =
            AgainError::Asked { serial: "S1".to_owned(), when: "today".to_owned(), how: "scan it once more" };
        assert_eq!(says(&Event::NotBegun { why: Said::of(&passed) }), "", "which is about the unit");
    }

    #[test]
    fn the_log_says_once_that_a_result_is_not_saved() {
        let mut lane = Logged::default();
        let unsaved = Event::NotAtPlant { why: Saying::NotAtPlant.into() };
        assert!(
            lane.take("2", &unsaved).unwrap().contains("lane 2 shows no verdict on its board: the result")
        );
        assert_eq!(lane.take("2", &unsaved), None);
    }
}
