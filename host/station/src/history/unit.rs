//! All that is known of a unit.

use std::collections::BTreeMap;

use serde::Serialize;

use super::mismatch::{Mismatch, mismatches};
use super::runs::RunLine;
use crate::record::Attachment;
use crate::said::Said;
use crate::store::{DatabaseError, Found, Snapshot, StoreError, Waiver, statements, values};

/// A unit with everything that happened to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unit {
    /// Its id.
    pub id: String,
    /// The product.
    pub product: String,
    /// The serial number.
    pub serial: String,
    /// When it was first seen, in milliseconds since 1970, UTC.
    pub first_seen_ms: i64,
    /// Its runs, the newest first.
    pub runs: Vec<UnitRun>,
    /// The devices that it was bound to, the latest first.
    pub bindings: Vec<Binding>,
    /// What stations of a plant bound differently about it; none at a station.
    pub mismatches: Vec<Mismatch>,
}

/// A device under a serial number, from when to when.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Binding {
    /// The FPGA's own number, in hexadecimal.
    pub device: String,
    /// Since when, in milliseconds since 1970, UTC.
    pub from_ms: i64,
    /// Until when; `None` for the binding that holds.
    pub to_ms: Option<i64>,
    /// Who bound them.
    pub operator: String,
    /// Why.
    pub reason: String,
}

/// A run of a unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnitRun {
    /// The run in one line.
    #[serde(flatten)]
    pub line: RunLine,
    /// The variant; empty if the serial number names none.
    pub variant: String,
    /// The target string of the board.
    pub target: String,
    /// The FPGA's own number, in hexadecimal; `None`, like the next one, if the board did not say what it is.
    pub device: Option<String>,
    /// The build's commit, in hexadecimal.
    pub build: Option<String>,
    /// Every try of every step, in order.
    pub steps: Vec<StepTry>,
    /// The parts that are suspected, the likeliest first.
    pub suspects: Vec<Suspect>,
    /// Evidence in addition to the record.
    pub attachments: Vec<Attachment>,
    /// The waiver of its FAIL.
    pub waivers: Vec<Waiver>,
    /// What a PASS did not test, by step; empty until [`Self::read_record`].
    pub not_exercised: Vec<StepUntested>,
}

impl UnitRun {
    /// Reads what no table has; it stays empty where the record is not here.
    pub(crate) fn read_record(&mut self, of: &Snapshot) {
        let record = self.line.record_sha256.as_ref().and_then(|hash| of.record(hash).ok());
        let Some((record, _)) = record else { return };
        let untested = |(step, parts): (&str, Vec<Said>)| StepUntested { step: step.to_owned(), parts };
        self.not_exercised = record.not_exercised().into_iter().map(untested).collect();
    }
}

/// What a step of a PASS did not test.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StepUntested {
    /// The step's name.
    pub step: String,
    /// The parts.
    pub parts: Vec<Said>,
}

/// A try of a step.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StepTry {
    /// The step's place in the plan, from 1.
    pub seq: u32,
    /// Which try, from 1.
    pub attempt: u32,
    /// The step's name.
    pub name: String,
    /// `passed`, `failed`, `error` or `skipped`.
    pub outcome: String,
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
    /// When it ended.
    pub ended_ms: i64,
    /// What was seen, in one sentence.
    pub detail: String,
}

/// A part that is suspected.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suspect {
    /// The kind of part.
    pub part: String,
    /// Where.
    pub place: String,
    /// The share of what is wrong that it explains, 0 to 1.
    pub explained: f64,
}

impl Suspect {
    /// The part and its place, which names the part where that says more.
    #[must_use]
    pub fn named(&self) -> String {
        let Self { part, place, .. } = self;
        if place.contains(part) { place.clone() } else { format!("{part}, {place}") }
    }

    /// The share of what is wrong that it explains, in per cent; none if nothing was counted.
    #[must_use]
    pub fn share(&self) -> Option<f64> {
        (self.explained > 0.0).then_some(100.0 * self.explained)
    }
}

/// The units of this serial number: one for each product that has it.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn units(of: &Snapshot, serial: &str) -> Result<Vec<Unit>, StoreError> {
    let mut units = of.rows("to tell a unit", statements::UNITS_OF_SERIAL, values![serial], |row| {
        let (id, product, serial, first_seen_ms) = (row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?);
        Ok(Unit {
            id,
            product,
            serial,
            first_seen_ms,
            runs: Vec::new(),
            bindings: Vec::new(),
            mismatches: Vec::new(),
        })
    })?;
    let mismatches = mismatches(of)?;
    for unit in &mut units {
        let of_unit = mismatches.iter().filter(|one| one.is_of(&unit.product, &unit.serial));
        unit.mismatches = of_unit.cloned().collect();
        unit.runs = runs(of, OF_UNIT, &unit.id)?;
        let binding = |row: &Found<'_>| {
            let (device, from_ms, to_ms) = (row.get(0)?, row.get(1)?, row.get(2)?);
            Ok(Binding { device, from_ms, to_ms, operator: row.get(3)?, reason: row.get(4)? })
        };
        unit.bindings =
            of.rows("to tell a unit's devices", statements::UNIT_BINDINGS, values![&unit.id], binding)?;
    }
    Ok(units)
}

/// The run of this id, open or over; `None` if there is none.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn run_of(of: &Snapshot, id: &str) -> Result<Option<UnitRun>, StoreError> {
    Ok(runs(of, OF_RUN, id)?.into_iter().next())
}

/// The columns by which the runs of a unit are found, and by which one run is found.
const OF_UNIT: &str = "run.unit_id";
const OF_RUN: &str = "run.id";

/// The runs whose `column` has this value, the newest first.
fn runs(of: &Snapshot, column: &str, value: &str) -> Result<Vec<UnitRun>, StoreError> {
    let text = |text: &str| text.replace("{of}", column);
    let mut runs = of.rows("to tell a unit's runs", &text(statements::UNIT_RUNS), values![value], run)?;
    let mut steps = by_run(of, value, &text(statements::UNIT_STEPS), step)?;
    let mut suspects = by_run(of, value, &text(statements::UNIT_SUSPECTS), suspect)?;
    let mut attachments = by_run(of, value, &text(statements::UNIT_ATTACHMENTS), attachment)?;
    let mut waivers = by_run(of, value, &text(statements::UNIT_WAIVERS), Waiver::of)?;
    for run in &mut runs {
        let id = &run.line.id;
        run.steps = steps.remove(id).unwrap_or_default();
        run.suspects = suspects.remove(id).unwrap_or_default();
        run.attachments = attachments.remove(id).unwrap_or_default();
        run.waivers = waivers.remove(id).unwrap_or_default();
    }
    Ok(runs)
}

/// What `one` makes of the rows of these runs, by the run, which is in their first column.
fn by_run<T>(
    of: &Snapshot,
    value: &str,
    text: &str,
    one: impl Fn(&Found<'_>) -> Result<T, DatabaseError>,
) -> Result<BTreeMap<String, Vec<T>>, StoreError> {
    let rows = of.rows("to tell a unit's runs", text, values![value], |row| Ok((row.get(0)?, one(row)?)))?;
    let mut by_run = BTreeMap::<String, Vec<T>>::new();
    for (run, one) in rows {
        by_run.entry(run).or_default().push(one);
    }
    Ok(by_run)
}

fn run(row: &Found<'_>) -> Result<UnitRun, DatabaseError> {
    Ok(UnitRun {
        line: RunLine::of(row)?,
        variant: row.get(18)?,
        target: row.get(19)?,
        device: row.get(20)?,
        build: row.get(21)?,
        steps: Vec::new(),
        suspects: Vec::new(),
        attachments: Vec::new(),
        waivers: Vec::new(),
        not_exercised: Vec::new(),
    })
}

fn step(row: &Found<'_>) -> Result<StepTry, DatabaseError> {
    Ok(StepTry {
        seq: row.get(1)?,
        attempt: row.get(2)?,
        name: row.get(3)?,
        outcome: row.get(4)?,
        started_ms: row.get(5)?,
        ended_ms: row.get(6)?,
        detail: row.get(7)?,
    })
}

fn suspect(row: &Found<'_>) -> Result<Suspect, DatabaseError> {
    Ok(Suspect { part: row.get(1)?, place: row.get(2)?, explained: row.get(3)? })
}

fn attachment(row: &Found<'_>) -> Result<Attachment, DatabaseError> {
    let bytes: i64 = row.get(3)?;
    let (name, sha256, media_type) = (row.get(1)?, row.get(2)?, row.get(4)?);
    Ok(Attachment { name, sha256, bytes: bytes.unsigned_abs(), media_type })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_named_once() {
        for (part, place, named) in [
            ("data bit", "line memory, data bit 7 stuck at 1", "line memory, data bit 7 stuck at 1"),
            ("memory", "bit 3", "memory, bit 3"),
        ] {
            let suspect = Suspect { part: part.to_owned(), place: place.to_owned(), explained: 1.0 };
            assert_eq!(suspect.named(), named);
        }
    }
}
