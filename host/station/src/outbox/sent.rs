//! Whether the plant has a run, and why if it does not take it.

use std::thread;
use std::time::{Duration, Instant};

use crate::said::Said;
use crate::store::{Folder, LEASE_MS, SINK_OF_PLANT, Snapshot, StoreError};

/// How long a plant that answers may take nothing: as long as a plant may be away before a lease runs out.
const PATIENCE: Duration = Duration::from_millis(LEASE_MS.unsigned_abs());

/// How often it is looked whether the plant has a run: the outbox looks no oftener for what it could send, and each look opens the
/// database.
const LOOK: Duration = Duration::from_millis(200);

/// The codes of reasons why the plant does not take something that may end without a person.
const PASSING: [&str; 3] = ["plant-refuses", "plant-without-run", "plant-kept-nothing"];

/// The state of a run at the plant.
#[derive(Debug)]
pub(crate) enum Sent {
    /// The plant has it.
    Yes,
    /// It will be sent when the outbox can.
    NotYet,
    /// The plant does not take it, for this reason.
    Refused(Said),
}

/// The state of a run at the plant. Waits until the plant has it, the run waits for a person, the plant has taken nothing for too
/// long, or the wait `is_over`.
pub(crate) fn awaited(folder: &Folder, run: &str, is_over: &dyn Fn() -> bool) -> Result<Sent, StoreError> {
    awaited_for(folder, run, PATIENCE, is_over)
}

/// The same with a plant that may take nothing for `patience`.
fn awaited_for(
    folder: &Folder,
    run: &str,
    patience: Duration,
    is_over: &dyn Fn() -> bool,
) -> Result<Sent, StoreError> {
    let mut until = Instant::now() + patience;
    loop {
        let entry = folder.at_plant(run)?;
        if entry.is_done {
            return Ok(Sent::Yes);
        }
        if let Some(said) = entry.said.as_ref().filter(|_| entry.is_dead) {
            return Ok(Sent::Refused(said.clone()));
        }
        if is_over() {
            return Ok(Sent::NotYet);
        }
        if Instant::now() >= until {
            // Nothing is said of the run itself while it waits in line after others.
            if let Some(said) = entry.said.map_or_else(|| said_last(folder), |said| Ok(Some(said)))? {
                return Ok(Sent::Refused(said));
            }
            until += patience;
        }
        thread::sleep(LOOK);
    }
}

/// Why a person has to act before the plant takes anything, with the causes of that; empty if it may take it without one.
pub(crate) fn needs_person(folder: &Folder) -> Vec<Said> {
    // If that cannot be read now, it is looked for again.
    let said = said_last(folder).ok().flatten().filter(|said| !PASSING.contains(&said.code.as_str()));
    let Some(mut said) = said else { return Vec::new() };
    let causes = std::mem::take(&mut said.causes);
    [said].into_iter().chain(causes).collect()
}

/// What the plant said last about anything that will be tried again.
fn said_last(folder: &Folder) -> Result<Option<Said>, StoreError> {
    let unsent = Snapshot::take(folder)?.unsent()?;
    Ok(unsent.into_iter().find(|unsent| unsent.sink == SINK_OF_PLANT).and_then(|unsent| unsent.said))
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::codes;
    use crate::store::Store;

    #[test]
    fn every_reason_that_may_end_without_a_person_exists() {
        assert!(PASSING.iter().all(|code| codes::all().contains(&(*code).into())), "{PASSING:?}");
    }

    /// A station's folder.
    fn folder() -> (tempfile::TempDir, Folder) {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::new(place.path());
        drop(Store::open(&folder).unwrap());
        (place, folder)
    }

    /// A run for the plant, with what the plant last said of it, and whether it waits for a person.
    fn entered(folder: &Folder, number: char, said: Option<&str>, is_dead: bool) -> String {
        let run = number.to_string().repeat(36);
        let entry = "INSERT INTO outbox (sink, kind, subject, attempts, next_ms, dead_ms, said) VALUES ($1, 'run', $2, $3, 0, $4, $5)";
        let database = rusqlite::Connection::open(folder.database()).unwrap();
        let values = (SINK_OF_PLANT, &run, i64::from(said.is_some()), is_dead.then_some(1), said);
        database.execute(entry, values).unwrap();
        run
    }

    #[test]
    fn what_waits_for_a_person_is_waited_for_no_longer() {
        let (_place, folder) = folder();
        let run = entered(&folder, '0', Some("no"), true);
        let sent = awaited(&folder, &run, &|| panic!("it is waited for")).unwrap();
        assert!(matches!(&sent, Sent::Refused(said) if said.message == "no"), "{sent:?}");
    }

    /// Whoever waits has a board.
    #[test]
    fn a_plant_that_answers_and_takes_nothing_is_waited_for_as_long_as_patience_lasts() {
        const SHORT: Duration = Duration::from_millis(1);
        let (_place, one) = folder();
        let run = entered(&one, '1', Some("not now"), false);
        let asked = Cell::new(0);
        // Ends the test if nothing else does.
        let counted = || asked.replace(asked.get() + 1) > 100;
        let sent = awaited_for(&one, &run, SHORT, &counted).unwrap();
        assert!(matches!(&sent, Sent::Refused(said) if said.message == "not now"), "{sent:?}");
        asked.set(0);
        let sent =
            awaited_for(&one, &run, SHORT * 1_000_000, &|| asked.replace(asked.get() + 1) > 1).unwrap();
        assert!(matches!(sent, Sent::NotYet), "there is patience: {sent:?}");
        // A run that waits in line, behind one of which the plant said something.
        let behind = entered(&one, '2', None, false);
        asked.set(0);
        let sent = awaited_for(&one, &behind, SHORT, &counted).unwrap();
        assert!(matches!(&sent, Sent::Refused(said) if said.message == "not now"), "{sent:?}");
        // The control: nothing was said, so the plant may be away.
        let (_place, silent) = folder();
        let run = entered(&silent, '1', None, false);
        asked.set(0);
        let sent = awaited_for(&silent, &run, SHORT, &|| asked.replace(asked.get() + 1) > 3).unwrap();
        assert!(matches!(sent, Sent::NotYet), "{sent:?}");
    }
}
