//! Compares a table with its rebuilt copy.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::Fault;
use crate::store::{Key, Row, Rows, StoreError, lacks};

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

/// Adds a fault for each column in which the two rows differ, and one alone for a column that the table has lost.
fn differing(table: &'static str, key: &Key, stored: Row, rebuilt: Row, faults: &mut Vec<Fault>) {
    if stored == rebuilt {
        return;
    }
    let mut stored: BTreeMap<_, _> = stored.into_iter().collect();
    for (column, rebuilt) in rebuilt {
        match stored.remove(&column) {
            None => lost(&format!("{table}.{column}"), faults),
            Some(stored) if stored == rebuilt => {}
            Some(stored) => faults.push(Fault::Differs { table, key: text(key), column, stored, rebuilt }),
        }
    }
}

/// Adds the fault that the column `name` is lost, unless it was told.
fn lost(name: &str, faults: &mut Vec<Fault>) {
    let said = lacks(name);
    if !faults.iter().any(|fault| matches!(fault, Fault::Database { said: told } if *told == said)) {
        faults.push(Fault::Database { said });
    }
}

fn text(key: &Key) -> String {
    key.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}
