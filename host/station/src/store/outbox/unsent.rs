//! What is unsent at each sink, and what of it waits for a person.

use serde::Serialize;

use super::super::database::values;
use super::super::{Snapshot, StoreError, statements as sql};
use super::{Entry, FIRST_WAIT_MS, Kind, LONGEST_WAIT_MS, entry, said};
use crate::said::{Said, as_text, as_text_if_any};
use crate::{clock, ids};

/// The most entries of a sink that are listed as waiting for a person: a sink may have refused everything for years.
pub(crate) const DEAD_SHOWN: u32 = 100;

/// What is unsent at a sink.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unsent {
    /// The sink.
    pub sink: String,
    /// Entries that it does not certainly have.
    pub entries: u32,
    /// Those of them that are runs and waivers, not lines of the audit.
    pub results: u32,
    /// Those of them that wait for a person.
    pub dead: u32,
    /// When the subject of the first of them came about, in milliseconds since 1970, UTC.
    pub since_ms: i64,
    /// What the sink said last to one that will be tried again.
    #[serde(serialize_with = "as_text_if_any")]
    pub said: Option<Said>,
}

/// How much a sink does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Backlog {
    /// Entries.
    pub(crate) entries: u32,
    /// Those of them that are runs and waivers, not lines of the audit.
    pub(crate) results: u32,
    /// Those of them that wait for a person.
    pub(crate) dead: u32,
    /// Whether any of the others was tried in vain.
    pub(crate) was_tried: bool,
}

/// An entry that waits for a person.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Dead {
    /// The sink.
    pub sink: String,
    /// The entry.
    #[serde(flatten)]
    pub entry: Entry,
    /// Since when, in milliseconds since 1970, UTC.
    pub dead_ms: i64,
    /// What the sink said.
    #[serde(serialize_with = "as_text")]
    pub said: Said,
}

impl Snapshot {
    /// What is unsent at each sink that does not have everything, as far as it was entered for the sink.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn unsent(&self) -> Result<Vec<Unsent>, StoreError> {
        let waits = values![FIRST_WAIT_MS, LONGEST_WAIT_MS];
        let mut unsent = self.rows("to tell what is to be sent", sql::OUTBOX_STATE, waits, |row| {
            let since_ms = ids::made_ms(row.text(4)?);
            let (sink, entries, results, dead) = (row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?);
            Ok(Unsent { sink, entries, results, dead, since_ms, said: said(row, 5)? })
        })?;
        let now_ms = clock::now_ms();
        for Unsent { sink, since_ms, .. } in unsent.iter_mut().filter(|unsent| unsent.since_ms > now_ms) {
            // Its id was drawn behind those of a clock that was ahead.
            let of = values![&**sink, &Kind::Run];
            let first =
                self.rows("to tell since when", sql::OUTBOX_SINCE, of, |row| row.get::<Option<i64>>(0))?;
            *since_ms = first.into_iter().flatten().fold(*since_ms, i64::min);
        }
        Ok(unsent)
    }

    /// How much this sink does not have, without a look at what others do not have.
    ///
    /// # Errors
    /// Like [`Self::unsent`].
    pub(crate) fn backlog(&self, sink: &str) -> Result<Backlog, StoreError> {
        let counted =
            self.rows("to tell how much is to be sent", sql::OUTBOX_LEFT, values![sink], |row| {
                let (entries, results, dead) = (row.get(0)?, row.get(1)?, row.get(2)?);
                Ok(Backlog { entries, results, dead, was_tried: row.get::<u32>(3)? > 0 })
            })?;
        Ok(counted.into_iter().next().unwrap_or_default())
    }

    /// The same as [`Self::unsent`], with what will be entered for these sinks when it is sent: what was kept by a program that knew no sinks.
    ///
    /// # Errors
    /// Like [`Self::unsent`].
    pub(crate) fn unsent_to<'a>(
        &self,
        sinks: impl Iterator<Item = &'a str>,
    ) -> Result<Vec<Unsent>, StoreError> {
        let mut unsent = self.unsent()?;
        for sink in sinks {
            let unentered =
                self.rows("to tell what is to be sent", sql::UNENTERED, values![sink], |row| {
                    Ok((Kind::named(row, 0)?, ids::made_ms(row.text(1)?)))
                })?;
            let Some(first_ms) = unentered.iter().map(|(_, made_ms)| *made_ms).min() else { continue };
            let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
            let entries = count(unentered.len());
            let results = count(unentered.iter().filter(|(kind, _)| *kind != Kind::Audit).count());
            match unsent.iter_mut().find(|unsent| unsent.sink == sink) {
                Some(unsent) => {
                    unsent.entries += entries;
                    unsent.results += results;
                    unsent.since_ms = unsent.since_ms.min(first_ms);
                }
                None => unsent.push(Unsent {
                    sink: sink.to_owned(),
                    entries,
                    results,
                    dead: 0,
                    since_ms: first_ms,
                    said: None,
                }),
            }
        }
        unsent.sort_by(|one, other| one.sink.cmp(&other.sink));
        Ok(unsent)
    }

    /// The first `DEAD_SHOWN` entries of each of these sinks that wait for a person; [`Unsent::dead`] counts all of them.
    ///
    /// # Errors
    /// Like [`Self::unsent`].
    pub fn dead(&self, unsent: &[Unsent]) -> Result<Vec<Dead>, StoreError> {
        let mut dead = Vec::new();
        for Unsent { sink, .. } in unsent.iter().filter(|unsent| unsent.dead > 0) {
            let of = values![sink, DEAD_SHOWN];
            dead.extend(self.rows("to tell what waits for a person", sql::OUTBOX_DEAD, of, |row| {
                let said = said(row, 5)?.unwrap_or_else(|| Said::uncoded(String::new()));
                Ok(Dead { sink: row.get(0)?, entry: entry(row, 1)?, dead_ms: row.get(4)?, said })
            })?);
        }
        Ok(dead)
    }
}
