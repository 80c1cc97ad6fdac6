//! Which device has which serial number: the FPGA's own number, and the label on the board.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::audit::{Deed, Line};
use super::database::{Database, DatabaseError, Row, values};
use super::{Reason, Store, StoreError, statements as sql};
use crate::clock;
use crate::record::RunHead;
use crate::said::{Said, Saying};

/// The reason of a binding by a run.
pub(super) const BY_RUN: &str = "first judgement";
/// The audit's name for a change by a person.
pub(super) const REBIND: &str = "rebind";

/// Whether a device may be tested under a serial number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Admission {
    /// Neither was bound before: they are bound when the board is judged.
    New,
    /// They are bound to each other.
    Known,
    /// One of them is bound to another, or the device is being tested elsewhere.
    Refused {
        /// Which board it is, and which was scanned.
        why: Said,
    },
}

/// A change of a binding by a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rebinding {
    /// Its line in the audit, a UUID of version 7.
    pub id: String,
    /// When, in milliseconds since 1970, UTC.
    pub at_ms: i64,
    /// Who.
    pub operator: String,
    /// The unit, a UUID.
    pub unit_id: String,
    /// The device that the unit has from then on; none if the next judgement is to bind it.
    pub device: Option<String>,
    /// Why.
    pub reason: String,
}

/// What the audit keeps of a rebinding in addition to who, when and which unit.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Detail {
    pub(super) device: Option<String>,
    pub(super) reason: String,
}

impl Store {
    /// Whether the board that reports `device` may be judged in `run`, by what is bound and by what was when the run began. If
    /// so, no other run may have the device until that run is over.
    ///
    /// # Errors
    /// [`StoreError`] when the database cannot be read.
    pub fn admit(&mut self, run: &RunHead, device: &str) -> Result<Admission, StoreError> {
        if self.admitted.get(device).is_some_and(|other| *other != run.id) {
            let why = Saying::DeviceElsewhere { device: device.to_owned() };
            return Ok(Admission::Refused { why: why.into() });
        }
        let known = self.read("to tell which device has which serial number", |from| {
            let unit = |row: &Row<'_>| Ok(Unit { product: row.get(0)?, serial: row.get(1)? });
            let unit = from.first(sql::UNIT_OF_DEVICE, values![device], unit)?;
            let bound = from.first(sql::DEVICE_OF_UNIT, values![&run.unit_id], |row| row.get(0))?;
            match (unit, bound) {
                (None, None) => Known::unbound_since(from, run, device),
                (unit, device) => Ok(Known { unit, device }),
            }
        })?;
        let admission =
            known.admits(&Unit { product: run.product.clone(), serial: run.serial.clone() }, device);
        if !matches!(admission, Admission::Refused { .. }) {
            self.admitted.insert(device.to_owned(), run.id.clone());
        }
        Ok(admission)
    }

    /// Ends the bindings of the unit with this serial number, and of `device` if one is given. The two are then bound to
    /// each other; without a device, the next judgement of the unit binds it. The reason is kept.
    ///
    /// # Errors
    /// [`RebindError`] when there is no such unit, it is being tested, or the device is none.
    pub fn rebind(&mut self, change: &Change<'_>) -> Result<Rebinding, RebindError> {
        if let Some(device) = change.device.filter(|device| !is_device(device)) {
            return Err(RebindError::NoDevice { device: device.to_owned() });
        }
        let unit_id = self.unit(change)?;
        let open: Option<String> = self.read("to tell its open runs", |from| {
            from.first(sql::OPEN_RUN_OF_UNIT, values![&unit_id], |row| row.get(0))
        })?;
        if open.is_some() || change.device.is_some_and(|device| self.admitted.contains_key(device)) {
            return Err(RebindError::UnderTest { serial: change.serial.to_owned() });
        }
        let at_ms = clock::now_ms();
        let rebinding = Rebinding {
            id: self.new_id(at_ms)?.to_string(),
            at_ms,
            operator: change.operator.to_owned(),
            unit_id,
            device: change.device.map(str::to_owned),
            reason: change.reason.to_string(),
        };
        let sinks = Arc::clone(&self.sinks);
        self.change("another binding", |to| {
            audit(to, &sinks, &rebinding)?;
            rebind(to, &rebinding)
        })?;
        Ok(rebinding)
    }

    /// The unit that is meant.
    fn unit(&mut self, change: &Change<'_>) -> Result<String, RebindError> {
        let units: Vec<(String, String)> = self.read("to tell its units", |from| {
            from.all(sql::UNITS_OF_SERIAL, values![change.serial], |row| Ok((row.get(0)?, row.get(1)?)))
        })?;
        let is_meant = |product: &str| change.product.is_none_or(|meant| meant == product);
        let mut meant = units.into_iter().filter(|(_, product)| is_meant(product));
        let serial = || change.serial.to_owned();
        match (meant.next(), meant.next()) {
            (Some((unit, _)), None) => Ok(unit),
            (None, _) => Err(RebindError::Unknown { serial: serial() }),
            (Some((_, first)), Some((_, second))) => {
                Err(RebindError::Several { serial: serial(), first, second })
            }
        }
    }
}

/// A change of a binding that a person wants.
#[derive(Clone, Copy, Debug)]
pub struct Change<'a> {
    /// The serial number.
    pub serial: &'a str,
    /// The product, if several have this serial number.
    pub product: Option<&'a str>,
    /// The device that it is to have, as 16 hexadecimal digits; none for the one that its next judgement finds.
    pub device: Option<&'a str>,
    /// Who wants it.
    pub operator: &'a str,
    /// Why.
    pub reason: &'a Reason,
}

/// A binding that cannot be changed.
#[derive(Debug, thiserror::Error)]
pub enum RebindError {
    /// No unit of this serial number was ever tested here.
    #[error("no unit `{serial}` was ever tested here; check the serial number and the product")]
    Unknown {
        /// The serial number.
        serial: String,
    },
    /// Units of several products have this serial number.
    #[error("`{serial}` is a serial number of {first} and of {second}; say which with --product")]
    Several {
        /// The serial number.
        serial: String,
        /// One product.
        first: String,
        /// Another.
        second: String,
    },
    /// The text is not the number of a device.
    #[error(
        "`{device}` is no device; give 16 hexadecimal digits in lower case, not all 0, as a run prints them after \
         `device`"
    )]
    NoDevice {
        /// What was given.
        device: String,
    },
    /// The unit, or its device, is being tested in a lane.
    #[error("the unit `{serial}`, or its device, is being tested; wait until the run is over")]
    UnderTest {
        /// The serial number.
        serial: String,
    },
    /// The store.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Whether this is the number of an FPGA as records write it.
#[must_use]
pub(crate) fn is_device(text: &str) -> bool {
    let is_hexadecimal = text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
    text.len() == 16 && is_hexadecimal && text.bytes().any(|digit| digit != b'0')
}

/// A unit by its label.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Unit {
    product: String,
    serial: String,
}

/// What was bound before: the unit that has the device, and the device that the unit has.
#[derive(Clone, Debug, Default)]
struct Known {
    unit: Option<Unit>,
    device: Option<String>,
}

impl Known {
    /// What a person has unbound since `run` began. Whoever rebuilds the tables enters the run before that change, and could not
    /// bind there what still belongs to another.
    fn unbound_since(from: &mut dyn Database, run: &RunHead, device: &str) -> Result<Self, DatabaseError> {
        let unbound = from.first(sql::UNBOUND_SINCE, values![&run.id, device, &run.unit_id], |row| {
            let unit = Unit { product: row.get(0)?, serial: row.get(1)? };
            let bound: String = row.get(2)?;
            let is_its_unit = bound == device;
            Ok(Self { unit: is_its_unit.then_some(unit), device: (!is_its_unit).then_some(bound) })
        })?;
        Ok(unbound.unwrap_or_default())
    }

    /// Whether the board that reports `device` may be judged as the scanned unit.
    fn admits(&self, scanned: &Unit, device: &str) -> Admission {
        let why = match (&self.unit, &self.device) {
            (None, None) => return Admission::New,
            (Some(unit), _) if unit == scanned => return Admission::Known,
            (Some(unit), _) if unit.product != scanned.product => {
                let Unit { serial, product } = unit.clone();
                Saying::OtherProduct { serial, product, scanned: scanned.serial.clone() }
            }
            (Some(unit), _) => {
                Saying::OtherSerial { serial: unit.serial.clone(), scanned: scanned.serial.clone() }
            }
            (None, Some(other)) => {
                let (serial, device, found) = (scanned.serial.clone(), other.clone(), device.to_owned());
                Saying::OtherDevice { serial, device, found }
            }
        };
        Admission::Refused { why: why.into() }
    }
}

/// Binds a new device to the unit of the run that judged it.
pub(super) fn bind(
    to: &mut dyn Database,
    run: &RunHead,
    device: &str,
    at_ms: i64,
) -> Result<u64, DatabaseError> {
    to.execute(sql::ADD_BINDING, values![&run.id, device, &run.unit_id, at_ms, &run.operator, BY_RUN])
}

/// Carries out a change by a person.
pub(super) fn rebind(to: &mut dyn Database, change: &Rebinding) -> Result<(), DatabaseError> {
    let Rebinding { id, at_ms, operator, unit_id, device, reason } = change;
    to.execute(sql::END_BINDINGS, values![*at_ms, unit_id, device.as_ref()])?;
    if let Some(device) = device {
        to.execute(sql::ADD_BINDING, values![id, device, unit_id, *at_ms, operator, reason])?;
    }
    Ok(())
}

fn audit(to: &mut dyn Database, sinks: &[String], change: &Rebinding) -> Result<(), DatabaseError> {
    let Rebinding { id, at_ms, operator, unit_id, device, reason } = change;
    let detail = serde_json::to_string(&Detail { device: device.clone(), reason: reason.clone() })?;
    let deed = Deed { operator, act: REBIND, subject: unit_id, detail: &detail };
    Line { id: id.clone(), at_ms: *at_ms, deed }.enter(to, sinks)
}

/// Every change by a person, the earliest first.
pub(super) fn rebindings(from: &mut dyn Database) -> Result<Vec<Rebinding>, DatabaseError> {
    from.all(sql::AUDIT_OF_ACT, values![REBIND], |row| {
        let Detail { device, reason } = serde_json::from_str(row.text(4)?)?;
        let (id, at_ms, operator, unit_id) = (row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?);
        Ok(Rebinding { id, at_ms, operator, unit_id, device, reason })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(serial: &str) -> Unit {
        Unit { product: "CAM-A".to_owned(), serial: serial.to_owned() }
    }

    fn refusal(known: &Known, serial: &str, device: &str) -> String {
        match known.admits(&unit(serial), device) {
            Admission::Refused { why } => why.to_string(),
            other => panic!("{other:?}"),
        }
    }

    /// Each row of the table in docs/station-lanes.md.
    #[test]
    fn what_belongs_together_is_admitted_and_a_mix_up_is_refused() {
        let nothing = Known::default();
        assert_eq!(nothing.admits(&unit("CA17"), "d1"), Admission::New);
        let both = Known { unit: Some(unit("CA17")), device: Some("d1".to_owned()) };
        assert_eq!(both.admits(&unit("CA17"), "d1"), Admission::Known);
        let of_another = Known { unit: Some(unit("CA17")), device: None };
        assert_eq!(refusal(&of_another, "CA71", "d1"), "this board is CA17; you scanned CA71");
        let crossed = Known { unit: Some(unit("CA17")), device: Some("d2".to_owned()) };
        assert_eq!(refusal(&crossed, "CA71", "d1"), "this board is CA17; you scanned CA71");
        let exchanged = Known { unit: None, device: Some("d2".to_owned()) };
        assert_eq!(
            refusal(&exchanged, "CA71", "d1"),
            "CA71 is device d2; the board in the lane is device d1"
        );
        let other_product = Known {
            unit: Some(Unit { product: "CAM-B".to_owned(), serial: "CA71".to_owned() }),
            device: None,
        };
        assert_eq!(refusal(&other_product, "CA71", "d1"), "this board is CA71 of CAM-B; you scanned CA71");
    }
}
