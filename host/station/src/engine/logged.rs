//! What the log says of a lane, and what is counted: once that it begins no run or shows no verdict, and once that it does
//! again.

use halfrow::result::codes::CodeList;
use parking_lot::Mutex;

use crate::codes;
use crate::floor::Event;
use crate::said::Said;

/// The reason that it is the disk, which is full, or the database, which is not what it was.
pub(super) const STORE: &str = "store";

/// The reason of whatever is not sorted.
const OTHER: &str = "other";

/// Why the station itself begins no run, as it is counted.
const REASONS: [&str; 5] = ["clock", "plan", "plant", OTHER, STORE];

/// Whose doing it is that no run was begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whose {
    /// It is about one unit, and about nothing at the station.
    Unit,
    /// The station's own, for one of [`REASONS`].
    Station(&'static str),
}

/// Whose doing it is by the type of the error that says why, for all codes of the type.
const BY_TYPE: [(&str, Whose); 7] = [
    ("SerialError", Whose::Unit),
    ("AgainError", Whose::Unit),
    ("StoreError", Whose::Station(STORE)),
    ("BlobError", Whose::Station(STORE)),
    ("RecordError", Whose::Station(STORE)),
    ("CertificateError", Whose::Station("plant")),
    ("NoRandomness", Whose::Station(OTHER)),
];

/// The same by the code, where that says more than the type.
const BY_CODE: [(&str, Whose); 11] = [
    ("plant-refuses", Whose::Station("plant")),
    ("plant-without-record", Whose::Station("plant")),
    ("unit-being-judged", Whose::Unit),
    ("clocks-apart", Whose::Station("clock")),
    ("last-run-dated-ahead", Whose::Station("clock")),
    ("lane-process-unknown", Whose::Station(OTHER)),
    ("plan-file-other", Whose::Station("plan")),
    ("outbox-too-full", Whose::Station("plant")),
    ("disk-too-full", Whose::Station(STORE)),
    ("thread-missing", Whose::Station(OTHER)),
    ("settings-without-lane-or-plan", Whose::Station(OTHER)),
];

/// Every reason that is counted.
pub(super) fn reasons() -> impl Iterator<Item = &'static str> {
    REASONS.into_iter()
}

/// Why no run was begun, unless that is about one unit.
fn reason(why: &Said) -> Option<&'static str> {
    match sorted(why) {
        Some(Whose::Unit) => None,
        Some(Whose::Station(reason)) => Some(reason),
        None => Some(OTHER),
    }
}

/// Whose doing it is, as the error says, or else its causes.
fn sorted(why: &Said) -> Option<Whose> {
    let of_type = || {
        let has = |list: &&CodeList| list.codes.iter().any(|(code, _)| *code == why.code);
        let list = codes::lists().find(has)?;
        BY_TYPE.iter().find(|(error, _)| *error == list.error)
    };
    let found = BY_CODE.iter().find(|(code, _)| *code == why.code).or_else(of_type);
    found.map(|(_, whose)| *whose).or_else(|| why.causes.iter().find_map(sorted))
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
                is_new.then(|| format!("lane {name} begins no run: {}", why.with_codes()))
            }
            Event::Begun { .. } => self.refused.take().map(|_| format!("lane {name} begins runs again")),
            Event::Unsaved { why } | Event::NotAtPlant { why } => {
                let was_unsaved = std::mem::replace(&mut self.is_unsaved, true);
                (!was_unsaved)
                    .then(|| format!("lane {name} shows no verdict on its board: {}", why.with_codes()))
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
        let mut logged = self.0.lock();
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
    fn every_code_and_type_that_decides_what_is_counted_exists() {
        let known = codes::all();
        assert!(BY_CODE.iter().all(|(code, _)| known.contains(&(*code).into())), "{BY_CODE:?}");
        for (error, _) in BY_TYPE {
            assert!(codes::lists().any(|list| list.error == error), "{error}");
        }
        for (_, whose) in BY_TYPE.into_iter().chain(BY_CODE) {
            assert!(!matches!(whose, Whose::Station(reason) if !REASONS.contains(&reason)), "{whose:?}");
        }
    }

    /// What is not sorted must not send anybody to the disk.
    #[test]
    fn what_is_counted_follows_from_what_the_error_is_about() {
        let counted = |code: &str| reason(&Said { code: code.to_owned(), ..Said::uncoded(String::new()) });
        let of = |error: &str| codes::lists().find(|list| list.error == error).unwrap().codes;
        for (code, _) in of("SerialError").iter().chain(of("AgainError")) {
            assert_eq!(counted(code), None, "{code}");
        }
        let of_store: Vec<_> = of("StoreError").iter().map(|(code, _)| counted(code)).collect();
        let not_of_it = of_store.iter().filter(|of| **of != Some("store")).count();
        // Whoever adds a code says here whether it is about the disk or the database.
        assert_eq!((of_store.len(), not_of_it), (28, 6), "a unit, two clocks, a process and the plant twice");
        assert_eq!(["board-held", "lane-busy", ""].map(counted), [Some("other"); 3]);
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
