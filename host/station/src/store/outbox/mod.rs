//! What is to be sent on: each run, waiver and line of the audit has an entry for every sink. The entry is made in the
//! transaction that keeps the thing itself, and is open until the sink certainly has it.

mod acts;
mod unsent;

pub(crate) use unsent::Backlog;
pub(crate) use unsent::DEAD_SHOWN;
pub use unsent::{Dead, Unsent};

use serde::Serialize;
use strum::{AsRefStr, EnumString};

use super::database::{Database, DatabaseError, Row, values};
use super::{Folder, Store, StoreError, Waiver, statements as sql};
use crate::record::Record;
use crate::said::Said;
use crate::{clock, ids};

/// How long it is waited at most before something is sent for the second time, in milliseconds. Each wait is twice as long as the
/// one before, up to [`LONGEST_WAIT_MS`].
pub(crate) const FIRST_WAIT_MS: i64 = 1_000;
/// The longest wait.
pub(crate) const LONGEST_WAIT_MS: i64 = 300_000;

/// The plant's name among the sinks. A plant that moves to another address keeps it.
pub const SINK_OF_PLANT: &str = "plant";

/// What an entry is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, AsRefStr, EnumString)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Kind {
    /// A run that is over.
    Run,
    /// A waiver of its FAIL.
    Waiver,
    /// A line of the audit.
    Audit,
}

impl Kind {
    fn named(row: &Row<'_>, place: usize) -> Result<Self, DatabaseError> {
        row.text(place)?.parse().map_err(|_| DatabaseError::Dangling { what: "a kind of entry" })
    }
}

/// Something to be sent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// What it is.
    pub kind: Kind,
    /// Its id, a UUID of version 7.
    pub subject: String,
    /// How many attempts failed.
    pub attempts: u32,
}

/// The state of a run at a sink. A run that is not to be sent there is neither done nor dead.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AtSink {
    /// Whether the sink certainly has it.
    pub is_done: bool,
    /// Whether it waits for a person.
    pub is_dead: bool,
    /// What the sink said at the last attempt that failed.
    pub said: Option<Said>,
}

/// The content of an entry.
#[derive(Clone, Debug, PartialEq)]
pub enum Parcel {
    /// A run that is over.
    Run {
        /// Its record.
        record: Box<Record>,
        /// The exact text of the record.
        text: String,
        /// The hash of the text.
        sha256: String,
    },
    /// A waiver.
    Waiver {
        /// Its id.
        id: String,
        /// The waiver.
        waiver: Waiver,
    },
    /// A line of the audit.
    Audit(AuditLine),
}

/// A line of the audit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AuditLine {
    /// Its id.
    pub id: String,
    /// When, in milliseconds since 1970, UTC.
    pub at_ms: i64,
    /// Who.
    pub operator: String,
    /// What was done.
    pub act: String,
    /// What it was done to.
    pub subject: String,
    /// How.
    pub detail: String,
    /// Product and serial number, when the subject is a unit.
    pub unit: Option<[String; 2]>,
}

/// The result of an attempt to send an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Tried {
    /// The sink certainly has it.
    Done,
    /// It will be tried again.
    Again {
        /// When, in milliseconds since 1970, UTC.
        next_ms: i64,
        /// What the sink said.
        said: Said,
    },
    /// It will be tried again, and so will the runs that it belongs to, which the sink has lost.
    Early {
        /// When, in milliseconds since 1970, UTC.
        next_ms: i64,
        /// What the sink said.
        said: Said,
    },
    /// It waits for a person.
    Dead {
        /// What the sink said.
        said: Said,
    },
}

/// Enters `subject` for every sink.
pub(super) fn enter(
    to: &mut dyn Database,
    sinks: &[String],
    kind: Kind,
    subject: &str,
) -> Result<(), DatabaseError> {
    sinks.iter().try_for_each(|sink| to.execute(sql::ADD_TO_OUTBOX, values![sink, &kind, subject]).map(drop))
}

impl Store {
    /// Sends to these sinks from now on, including what was kept before.
    ///
    /// # Errors
    /// [`StoreError`] when the database does not take it.
    pub fn sends_to(&mut self, sinks: Vec<String>) -> Result<(), StoreError> {
        let enter_all = sql::ALL_TO_OUTBOX.replace("{of}", sql::UNENTERED);
        self.change("what is to be sent", |to| {
            sinks.iter().try_for_each(|sink| to.execute(&enter_all, values![sink]).map(drop))
        })?;
        self.sinks = sinks.into();
        Ok(())
    }

    /// Makes the failed entries for `sink` due at once, except those that wait for a person.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub(crate) fn due_at_once(&mut self, sink: &str) -> Result<(), StoreError> {
        self.change("what is to be sent now", |to| to.execute(sql::OUTBOX_AT_ONCE, values![sink]).map(drop))
    }

    /// The id of this folder, whatever the station's name is. It is drawn the first time.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub fn origin(&mut self) -> Result<String, StoreError> {
        let drawn = ids::new(clock::now_ms())?.to_string();
        self.change("what it is called", |to| {
            to.execute(sql::ADD_ORIGIN, values![&drawn])?;
            to.one(sql::ORIGIN, &[], |row| row.get(0))
        })
    }

    /// Keeps the results of these attempts, made at `now_ms`.
    ///
    /// # Errors
    /// Like [`Self::sends_to`].
    pub fn tried(&mut self, sink: &str, tried: &[(Entry, Tried)], now_ms: i64) -> Result<(), StoreError> {
        self.change("what was sent", |to| {
            tried.iter().try_for_each(|(Entry { kind, subject, .. }, tried)| {
                let (next_ms, dead_ms, said) = match tried {
                    Tried::Done => {
                        let of = values![now_ms, sink, kind, subject];
                        return to.execute(sql::OUTBOX_DONE, of).map(drop);
                    }
                    Tried::Again { next_ms, said } => (*next_ms, None, written(said)),
                    Tried::Early { next_ms, said } => {
                        to.execute(sql::OUTBOX_LOST, values![sink, subject])?;
                        (*next_ms, None, written(said))
                    }
                    Tried::Dead { said } => (now_ms, Some(now_ms), written(said)),
                };
                let of = values![next_ms, dead_ms, &said, sink, kind, subject];
                to.execute(sql::OUTBOX_FAILED, of).map(drop)
            })
        })
    }
}

impl Folder {
    /// The first entries that are due for `sink` at `now_ms`, in the order in which they came about. Entries that would wait for
    /// longer than `longest_ms`, because the clock was set back, are due as well.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn due(&self, sink: &str, now_ms: i64, longest_ms: i64) -> Result<Vec<Entry>, StoreError> {
        let latest_ms = now_ms.saturating_add(longest_ms);
        self.read("to tell what is to be sent", |from| {
            from.all(sql::OUTBOX_DUE, values![sink, now_ms, latest_ms], |row| entry(row, 0))
        })
    }

    /// When the first entry for `sink` is due that does not wait for a person, in milliseconds since 1970, UTC.
    ///
    /// # Errors
    /// Like [`Self::due`].
    pub(crate) fn next_due(&self, sink: &str) -> Result<Option<i64>, StoreError> {
        self.read("to tell when something is to be sent", |from| {
            from.one(sql::OUTBOX_NEXT, values![sink], |row| row.get(0))
        })
    }

    /// The newest run that `sink` certainly has.
    ///
    /// # Errors
    /// Like [`Self::due`].
    pub(crate) fn newest_sent(&self, sink: &str) -> Result<Option<String>, StoreError> {
        self.read("to tell what was sent last", |from| {
            from.first(sql::OUTBOX_NEWEST_SENT, values![sink, &Kind::Run], |row| row.get(0))
        })
    }

    /// The state of this run at the plant.
    ///
    /// # Errors
    /// Like [`Self::due`].
    pub fn at_plant(&self, run: &str) -> Result<AtSink, StoreError> {
        let found = self.read("to tell what was sent", |from| {
            from.first(sql::OUTBOX_ENTRY, values![SINK_OF_PLANT, &Kind::Run, run], |row| {
                let [done_ms, dead_ms] = [row.get::<Option<i64>>(0)?, row.get(1)?];
                Ok(AtSink { is_done: done_ms.is_some(), is_dead: dead_ms.is_some(), said: said(row, 2)? })
            })
        })?;
        Ok(found.unwrap_or_default())
    }

    /// The content of an entry.
    ///
    /// # Errors
    /// [`StoreError`] when it cannot be read, or is not as it was written.
    pub fn parcel(&self, Entry { kind, subject, .. }: &Entry) -> Result<Parcel, StoreError> {
        let otherwise = || StoreError::ReadsOtherwise { run: subject.clone() };
        match kind {
            Kind::Run => {
                let sha256 = self.verdict_of(subject)?.ok_or_else(otherwise)?.record_sha256;
                let bytes = self.blobs().get(&sha256)?;
                let record = Box::new(Record::parse(&bytes)?);
                let text = String::from_utf8(bytes).map_err(|_| otherwise())?;
                Ok(Parcel::Run { record, text, sha256 })
            }
            Kind::Waiver => {
                let waiver = self.read("to tell a waiver", |from| {
                    from.first(sql::WAIVER_BY_ID, values![subject], Waiver::of)
                })?;
                Ok(Parcel::Waiver { id: subject.clone(), waiver: waiver.ok_or_else(otherwise)? })
            }
            Kind::Audit => {
                let line = self.read("to tell the audit", |from| {
                    from.first(sql::AUDIT_BY_ID, values![subject], |row| audit_line(subject, row))
                })?;
                Ok(Parcel::Audit(line.ok_or_else(otherwise)?))
            }
        }
    }
}

/// What was said as it is kept: with its code, so that pages say it in their language.
fn written(said: &Said) -> String {
    // What cannot be written as JSON is kept without its code.
    serde_json::to_string(said).unwrap_or_else(|_| said.to_string())
}

/// What was said; earlier programs kept only the sentence.
fn said(row: &Row<'_>, place: usize) -> Result<Option<Said>, DatabaseError> {
    let kept: Option<String> = row.get(place)?;
    Ok(kept.map(|kept| serde_json::from_str(&kept).unwrap_or_else(|_| Said::uncoded(kept))))
}

fn entry(row: &Row<'_>, from: usize) -> Result<Entry, DatabaseError> {
    Ok(Entry { kind: Kind::named(row, from)?, subject: row.get(from + 1)?, attempts: row.get(from + 2)? })
}

fn audit_line(id: &str, row: &Row<'_>) -> Result<AuditLine, DatabaseError> {
    let (product, serial): (Option<String>, Option<String>) = (row.get(5)?, row.get(6)?);
    Ok(AuditLine {
        id: id.to_owned(),
        at_ms: row.get(0)?,
        operator: row.get(1)?,
        act: row.get(2)?,
        subject: row.get(3)?,
        detail: row.get(4)?,
        unit: product.zip(serial).map(|(product, serial)| [product, serial]),
    })
}

#[cfg(test)]
mod tests;
