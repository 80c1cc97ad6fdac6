//! What arrives at a plant from its stations, in any order, and again whenever they are not certain.

use halfrow::Verdict;

use super::super::bindings::{BY_RUN, Detail, REBIND};
use super::super::database::{Database, DatabaseError, values};
use super::super::outbox::AuditLine;
use super::super::{Waiver, rows, statements as sql};
use crate::plan::Plan;
use crate::record::{DeviceSeen, JobClaim, Record};

/// Enters a run that is over, with all that follows from its record. A run with this id that is already there stays as it is; it
/// gets its record back if only that was lost.
pub(super) fn run(
    to: &mut dyn Database,
    record: &Record,
    text: &str,
    hash: &str,
) -> Result<(), DatabaseError> {
    let unit = rows::unit(to, &record.run, &record.plan)?;
    to.one(sql::LOCK_UNIT, values![&unit], |_| Ok(()))?;
    let counts = settles_job(to, record)? && !record.is_of_reference();
    let is_new = entered(to, record, hash, &unit, counts)?;
    let is_same = |theirs: String| theirs == hash;
    if is_new || to.first(sql::HASH_OF, values![&record.run.id], |row| row.get(0))?.is_some_and(is_same) {
        to.execute(sql::ADD_RECORD, values![hash, text])?;
    }
    if !is_new {
        return Ok(());
    }
    if let Some(device) = record.binds() {
        let of = values![&record.run.id, device, &unit, record.ended_ms, &record.run.operator, BY_RUN];
        to.execute(sql::ADD_BINDING_UNLESS, of)?;
    }
    if record.device != DeviceSeen::NotChecked && record.conclusion.verdict != Verdict::Error {
        to.execute(sql::ADD_MISMATCH, values![&record.run.id])?;
    }
    Ok(())
}

/// Enters the run of `unit`, and what is counted from it; it `counts` unless it is superseded, or its unit checks shifts. Returns
/// whether it is new.
pub(in crate::store) fn entered(
    to: &mut dyn Database,
    record: &Record,
    hash: &str,
    unit: &str,
    counts: bool,
) -> Result<bool, DatabaseError> {
    if enter(to, record, hash, unit, counts)? == 0 {
        return Ok(false);
    }
    rows::parts(to, record)?;
    count(to, record, unit, counts)?;
    Ok(true)
}

/// Ends the job of the run, if it has one, or gives it back when nothing was judged. Returns whether the run counts: not if the
/// job was cancelled, or claimed again.
fn settles_job(to: &mut dyn Database, record: &Record) -> Result<bool, DatabaseError> {
    let Some(JobClaim { id, fence }) = &record.run.job else { return Ok(true) };
    let ended = &record.conclusion;
    let changed = match ended.verdict {
        Verdict::Error => {
            let is_free = i64::from(ended.is_from_outside());
            to.execute(sql::JOB_BACK, values![&ended.headline, *fence, is_free, id])?
        }
        Verdict::Pass | Verdict::Fail => to.execute(sql::JOB_DONE, values![&record.run.id, *fence, id])?,
    };
    // A job that is not here, because it is another plant's or was lost, supersedes nothing; nor does one that waits for its next
    // claim, or was put back to before this one.
    let of = values![id, *fence, &record.run.id];
    Ok(changed == 1 || to.first(sql::SUPERSEDING_JOB, of, |_| Ok(()))?.is_none())
}

/// Enters the plan of a job, which need not have a run yet.
pub(super) fn plan(to: &mut dyn Database, plan: &Plan, at_ms: i64) -> Result<(), DatabaseError> {
    let Plan { sha256, name, version, product, text, .. } = plan;
    to.execute(sql::ADD_PLAN, values![sha256, name, version, product, text, at_ms]).map(drop)
}

fn enter(
    to: &mut dyn Database,
    record: &Record,
    hash: &str,
    unit: &str,
    counts: bool,
) -> Result<u64, DatabaseError> {
    let (run, ended, board) = (&record.run, &record.conclusion, record.board.as_ref());
    to.execute(
        sql::ADD_RUN,
        values![
            &run.id,
            &run.station,
            &run.lane,
            unit,
            &record.plan.sha256,
            &run.variant,
            &run.operator,
            &run.target,
            run.fence,
            run.started_ms,
            record.ended_ms,
            ended.verdict,
            ended.exit_code,
            &ended.cause,
            &ended.headline,
            hash,
            board.map(|board| &board.kind),
            board.and_then(|board| board.device.as_ref()),
            board.map(|board| &board.build),
            i64::from(!counts),
        ],
    )
}

/// Counts the run as its station did. If later runs of its unit were counted already, those are counted anew.
fn count(to: &mut dyn Database, record: &Record, unit: &str, counts: bool) -> Result<(), DatabaseError> {
    let (id, plan, product) = (&record.run.id, &record.plan.name, &record.run.product);
    let later: i64 = to.one(sql::IS_LATE, values![unit, id, plan, product], |row| row.get(0))?;
    let is_judged = record.conclusion.verdict != Verdict::Error;
    let is_late = later > 0 && is_judged && counts;
    if !is_late {
        return rows::counted(to, id);
    }
    to.execute(sql::UNCOUNT_FIRST, values![unit, id, plan, product])?;
    to.execute(sql::COUNT_ON, values![unit, id, plan, product])?;
    to.execute(sql::FORGET_RETEST, values![unit, plan])?;
    rows::counted(to, id)?;
    // The run may be the unit's first judgement now, and is not its last one.
    let last: String = to.one(sql::LAST_JUDGED, values![unit, plan, product], |row| row.get(0))?;
    to.execute(sql::ADD_RETEST, values![&last]).map(drop)
}

/// Enters a waiver.
pub(super) fn waiver(to: &mut dyn Database, id: &str, waiver: &Waiver) -> Result<(), DatabaseError> {
    let Waiver { run, at_ms, operator, reason } = waiver;
    to.execute(sql::ADD_WAIVER_UNLESS, values![id, run, *at_ms, operator, reason]).map(drop)
}

/// Enters a line of the audit. A line about a unit is entered for the plant's unit with that serial number. What it bound is
/// bound here, too, until the next later binding, in whatever order the two arrive. Returns whether it was entered: not while the
/// plant does not have its unit, which comes with a run.
pub(super) fn audit(to: &mut dyn Database, line: &AuditLine) -> Result<bool, DatabaseError> {
    let AuditLine { id, at_ms, operator, act, subject, detail, unit } = line;
    let unit: Option<String> = match unit {
        Some([product, serial]) => {
            let found = to.first(sql::UNIT_OF, values![product, serial], |row| row.get(0))?;
            if found.is_none() {
                return Ok(false);
            }
            found
        }
        None => None,
    };
    let subject = unit.as_ref().unwrap_or(subject);
    let added = to.execute(sql::ADD_AUDIT_UNLESS, values![id, *at_ms, operator, act, subject, detail])?;
    let Some(unit_id) = unit.filter(|_| added == 1 && act == REBIND) else { return Ok(true) };
    let Detail { device, reason } = serde_json::from_str(detail)?;
    to.execute(sql::END_BINDINGS_THEN, values![*at_ms, id, &unit_id, device.as_ref()])?;
    if let Some(device) = device {
        to.execute(sql::ADD_REBINDING, values![id, &device, &unit_id, *at_ms, operator, &reason])?;
    }
    Ok(true)
}
