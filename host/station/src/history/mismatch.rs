//! Devices and units that two stations of a plant bound differently.

use serde::Serialize;

use crate::store::{Snapshot, StoreError, statements};

/// A device and a unit that a station takes to belong together, and what the plant knows instead.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mismatch {
    /// The station.
    pub station: String,
    /// The FPGA's own number, in hexadecimal.
    pub device: String,
    /// The unit's product.
    pub product: String,
    /// The unit's serial number.
    pub serial: String,
    /// The last run in which the station judged this device as this unit.
    pub run: String,
    /// When that run began, in milliseconds since 1970, UTC.
    pub last_ms: i64,
    /// The binding that contradicts it.
    pub bound: Bound,
}

/// A device and a unit that belong together, as a plant knows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Bound {
    /// The device.
    pub device: String,
    /// The unit's product.
    pub product: String,
    /// The unit's serial number.
    pub serial: String,
    /// Since when, in milliseconds since 1970, UTC.
    pub from_ms: i64,
    /// The station whose judgement bound them; `None` when a person did.
    pub station: Option<String>,
}

impl Mismatch {
    /// Whether it is about the unit of this product and serial number.
    #[must_use]
    pub fn is_of(&self, product: &str, serial: &str) -> bool {
        let [ours, theirs] = [(&self.product, &self.serial), (&self.bound.product, &self.bound.serial)];
        [ours, theirs].iter().any(|unit| (unit.0.as_str(), unit.1.as_str()) == (product, serial))
    }
}

/// All that are not settled, the latest first; none at a station, which refuses such boards. A person settles one by
/// binding anew what belongs together.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn mismatches(of: &Snapshot) -> Result<Vec<Mismatch>, StoreError> {
    of.rows("to tell what is bound differently", statements::MISMATCHES, &[], |row| {
        let station: String = row.get(10)?;
        Ok(Mismatch {
            station: row.get(0)?,
            device: row.get(1)?,
            product: row.get(2)?,
            serial: row.get(3)?,
            run: row.get(4)?,
            last_ms: row.get(5)?,
            bound: Bound {
                device: row.get(6)?,
                product: row.get(7)?,
                serial: row.get(8)?,
                from_ms: row.get(9)?,
                station: Some(station).filter(|name| !name.is_empty()),
            },
        })
    })
}
