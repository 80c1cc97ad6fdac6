//! Waivers: an engineer's word on a FAIL, in addition to it and never in its place.

use std::sync::Arc;

use halfrow::Verdict;
use halfrow::words::plain;
use serde::Serialize;

use super::audit::Deed;
use super::database::{DatabaseError, Row, values};
use super::{Kind, Reason, Store, StoreError, outbox, statements as sql};
use crate::clock;
use crate::ids::{self, NoRandomness};

/// The audit's name for a waiver, on which `sql/waivers-unlike-audit.sql` and `sql/plant/contradicted-waivers.sql` rely.
const WAIVE: &str = "waive";

/// A waiver of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Waiver {
    /// The run.
    pub run: String,
    /// When it was given, in milliseconds since 1970, UTC.
    pub at_ms: i64,
    /// Who gave it.
    pub operator: String,
    /// Why.
    pub reason: String,
}

impl Waiver {
    /// The waiver in a row of its run, moment, operator and reason.
    pub(crate) fn of(row: &Row<'_>) -> Result<Self, DatabaseError> {
        Ok(Self { run: row.get(0)?, at_ms: row.get(1)?, operator: row.get(2)?, reason: row.get(3)? })
    }
}

/// A waiver that is not given.
#[derive(Debug, thiserror::Error)]
pub enum NoWaiver {
    /// No finished run has this number.
    #[error("no run {run} is over; `halfrow-station history` lists the runs")]
    NoRun {
        /// What was asked for.
        run: String,
    },
    /// The run's verdict is not FAIL, so there is nothing to waive.
    #[error("the run {run} is {verdict}, and a waiver is for a FAIL; test the unit again instead")]
    NoFail {
        /// The run.
        run: String,
        /// Its verdict.
        verdict: String,
    },
    /// The run already has a waiver.
    #[error("the run {run} has a waiver already, by {}: {}; one is enough", plain(&waiver.operator), plain(&waiver.reason))]
    Waived {
        /// The run.
        run: String,
        /// The waiver that it has.
        waiver: Box<Waiver>,
    },
    /// An id cannot be made.
    #[error(transparent)]
    NoRandomness(#[from] NoRandomness),
    /// The store does not take it.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl Store {
    /// Waives the FAIL of this run. The run stays as it is; waiver and audit are entered in one transaction.
    ///
    /// # Errors
    /// [`NoWaiver`]
    pub fn waive(&mut self, run: &str, operator: &str, reason: &Reason) -> Result<Waiver, NoWaiver> {
        let reason: &str = reason;
        let stored = self.folder.verdict_of(run)?;
        let verdict = stored.ok_or_else(|| NoWaiver::NoRun { run: run.to_owned() })?.verdict;
        if verdict != Verdict::Fail {
            return Err(NoWaiver::NoFail { run: run.to_owned(), verdict: verdict.to_string() });
        }
        let at_ms = clock::now_ms();
        let id = ids::new(at_ms)?.to_string();
        let audit = Deed { operator, act: WAIVE, subject: run, detail: reason }.at(at_ms)?;
        let sinks = Arc::clone(&self.sinks);
        let before = self.change("a waiver", |to| {
            let before = to.first(sql::WAIVER_OF, values![run], Waiver::of)?;
            if before.is_none() {
                to.execute(sql::ADD_WAIVER, values![&id, run, at_ms, operator, reason])?;
                outbox::enter(to, &sinks, Kind::Waiver, &id)?;
                audit.enter(to, &sinks)?;
            }
            Ok(before)
        })?;
        if let Some(waiver) = before {
            return Err(NoWaiver::Waived { run: run.to_owned(), waiver: Box::new(waiver) });
        }
        let [run, operator, reason] = [run, operator, reason].map(str::to_owned);
        Ok(Waiver { run, at_ms, operator, reason })
    }
}
