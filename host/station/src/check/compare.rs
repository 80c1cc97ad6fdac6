//! Compares a table with its rebuilt copy.

use std::cmp::Ordering;

use super::Fault;
use crate::store::{Key, Row, Rows, StoreError};

/// Adds the differences between the two, which are sorted by key, to `faults`.
pub(super) fn compare(
    table: &'static str,
    mut stored: Rows<'_>,
    mut rebuilt: Rows<'_>,
    faults: &mut Vec<Fault>,
) -> Result<(), StoreError> {
    let (mut ours, mut theirs) = (stored.next().transpose()?, rebuilt.next().transpose()?);
    loop {
        let order = match (&ours, &theirs) {
            (None, None) => return Ok(()),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (Some((stored, _)), Some((rebuilt, _))) => stored.cmp(rebuilt),
        };
        let (stored_row, rebuilt_row) =
            (ours.take_if(|_| order != Ordering::Greater), theirs.take_if(|_| order != Ordering::Less));
        if stored_row.is_some() {
            ours = stored.next().transpose()?;
        }
        if rebuilt_row.is_some() {
            theirs = rebuilt.next().transpose()?;
        }
        match (stored_row, rebuilt_row) {
            (Some((key, stored)), Some((_, rebuilt))) => differing(table, &key, stored, rebuilt, faults),
            (Some((key, _)), None) => faults.push(Fault::Surplus { table, key: text(&key) }),
            (None, Some((key, _))) => faults.push(Fault::Missing { table, key: text(&key) }),
            (None, None) => {}
        }
    }
}

/// Adds a fault for each column in which the two rows differ.
fn differing(table: &'static str, key: &Key, stored: Row, rebuilt: Row, faults: &mut Vec<Fault>) {
    let differing = stored.into_iter().zip(rebuilt).filter(|(stored, rebuilt)| stored != rebuilt);
    faults.extend(differing.map(|((column, stored), (_, rebuilt))| {
        let key = text(key);
        Fault::Differs { table, key, column, stored, rebuilt }
    }));
}

fn text(key: &Key) -> String {
    key.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}
