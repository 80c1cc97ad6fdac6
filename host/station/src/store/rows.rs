//! The rows of a run in the tables. A database that is rebuilt from records gets its rows here, too.

use super::database::{Database, DatabaseError, values};
use super::{bindings, statements as sql};
use crate::record::{PlanRecord, Record, RunHead};

/// Enters unit, plan and open run. Returns the unit's id and the fence. The unit is made with the id that `run` names if
/// there is none of this serial number.
pub(super) fn open(
    to: &mut dyn Database,
    run: &RunHead,
    plan: &PlanRecord,
) -> Result<(String, i64), DatabaseError> {
    let unit = unit(to, run, plan)?;
    let fence = to.one(
        sql::OPEN_RUN,
        values![
            &run.id,
            &run.station,
            &run.lane,
            &unit,
            &plan.sha256,
            &run.variant,
            &run.operator,
            &run.target,
            run.started_ms,
        ],
        |row| row.get(0),
    )?;
    Ok((unit, fence))
}

/// Enters the plan and the unit of a run. Returns the unit's id.
pub(super) fn unit(to: &mut dyn Database, run: &RunHead, plan: &PlanRecord) -> Result<String, DatabaseError> {
    let PlanRecord { sha256, name, version, text, files: _ } = plan;
    let RunHead { product, serial, started_ms, .. } = run;
    to.execute(sql::ADD_PLAN, values![sha256, name, version, product, text, *started_ms])?;
    to.execute(sql::ADD_UNIT, values![&run.unit_id, product, serial, *started_ms])?;
    let unit: String = to.one(sql::UNIT_OF, values![product, serial], |row| row.get(0))?;
    // The run that is entered first need not have begun first.
    to.execute(sql::PLAN_EARLIER, values![*started_ms, sha256])?;
    to.execute(sql::UNIT_EARLIER, values![*started_ms, &unit])?;
    Ok(unit)
}

/// Ends a run, with all that belongs to it; that of a unit that checks shifts, which `is_reference` says, counts nowhere. Returns
/// the number of runs that it ended: 0, and then nothing is changed, when the run is not open, or another holder's.
pub(super) fn finish(
    to: &mut dyn Database,
    record: &Record,
    hash: &str,
    is_reference: bool,
) -> Result<u64, DatabaseError> {
    let id = &record.run.id;
    let (ended, board) = (&record.conclusion, record.board.as_ref());
    let changed = to.execute(
        sql::FINISH_RUN,
        values![
            ended.verdict,
            ended.exit_code,
            &ended.cause,
            &ended.headline,
            record.ended_ms,
            hash,
            board.map(|board| &board.kind),
            board.and_then(|board| board.device.as_ref()),
            board.map(|board| &board.build),
            i64::from(is_reference),
            id,
            record.run.fence,
        ],
    )?;
    if changed == 0 {
        return Ok(0);
    }
    if let Some(device) = record.binds() {
        bindings::bind(to, &record.run, device, record.ended_ms)?;
    }
    parts(to, record)?;
    counted(to, id)?;
    Ok(changed)
}

/// Updates what yields and failures are counted from by the run `id`, which is entered with all its parts and is its unit's last
/// one.
pub(super) fn counted(to: &mut dyn Database, id: &str) -> Result<(), DatabaseError> {
    for counted in [sql::ADD_DAY_COUNT, sql::ADD_RETEST, sql::ADD_FAILURES] {
        to.execute(counted, values![id])?;
    }
    Ok(())
}

/// Enters the parts of a run: steps, measurements, suspects, attachments.
pub(super) fn parts(to: &mut dyn Database, record: &Record) -> Result<(), DatabaseError> {
    let id = &record.run.id;
    for step in &record.steps {
        let (seq, attempt, outcome) = (step.seq, step.attempt, &step.outcome);
        to.execute(
            sql::ADD_STEP,
            values![id, seq, attempt, &step.name, outcome, step.started_ms, step.ended_ms, &step.detail],
        )?;
    }
    measurements(to, record)?;
    for (suspect, rank) in record.suspects.iter().zip(1_i64..) {
        to.execute(sql::ADD_SUSPECT, values![id, rank, &suspect.part, &suspect.place, suspect.explained])?;
    }
    for one in &record.attachments {
        to.execute(
            sql::ADD_ATTACHMENT,
            values![id, &one.name, &one.sha256, one.bytes as i64, &one.media_type],
        )?;
    }
    Ok(())
}

fn measurements(to: &mut dyn Database, record: &Record) -> Result<(), DatabaseError> {
    let of_steps = record.steps.iter().map(|step| (step.seq, step.attempt, &step.measurements));
    for (seq, attempt, measured) in of_steps.chain([(0, 1, &record.measurements)]) {
        for one in measured {
            to.execute(
                sql::ADD_MEASUREMENT,
                values![
                    &record.run.id,
                    seq,
                    attempt,
                    &one.name,
                    one.value,
                    &one.unit,
                    one.low,
                    one.high,
                    &one.blames,
                    &one.outcome,
                ],
            )?;
        }
    }
    Ok(())
}
