//! Which runs of a plan count as production.

use std::time::Duration;

use super::mock;
use super::read;

/// What a plan demands of a run that counts as production.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Production {
    /// Refuse anything but hardware.
    pub require_hardware: bool,
    /// The units that check every lane in each shift; `None` if production counts without them.
    pub shift: Option<Shift>,
}

/// How a lane is checked before its production counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shift {
    /// The serial number of a unit that must pass.
    pub good: String,
    /// What must fail.
    pub bad: Bad,
    /// How long the two results count.
    pub lasts: Duration,
}

/// What is known to be bad.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bad {
    /// The unit of this serial number.
    Unit(String),
    /// The [`mock`] board, with a fault that is drawn for every run.
    Mock,
}

impl Bad {
    /// The serial number that its runs in this lane have.
    #[must_use]
    pub fn serial(&self, lane: &str) -> String {
        match self {
            Self::Unit(serial) => serial.clone(),
            Self::Mock => mock::serial(lane),
        }
    }
}

impl Production {
    /// What the text of a plan that was once read whole demands; `None` if this program cannot read it. The files that
    /// the plan names may have changed since.
    #[must_use]
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        read::production_of(text).ok()
    }

    /// Whether the unit of this serial number checks shifts, and so is not a product.
    #[must_use]
    pub(crate) fn is_reference(&self, serial: &str) -> bool {
        mock::is_mock(serial) || self.references().contains(&serial)
    }

    /// The serial numbers of the units that check shifts; the mock has others.
    pub(crate) fn references(&self) -> Vec<&str> {
        let Some(Shift { good, bad, .. }) = &self.shift else { return Vec::new() };
        let bad = match bad {
            Bad::Unit(bad) => Some(bad.as_str()),
            Bad::Mock => None,
        };
        std::iter::once(good.as_str()).chain(bad).collect()
    }

    /// Whether a run of this serial number can count, in a lane that was checked.
    #[must_use]
    pub fn counts(&self, serial: &str) -> bool {
        self.require_hardware && !self.is_reference(serial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What checks a lane is judged again in every shift, and would count as a product each time.
    #[test]
    fn a_unit_that_checks_a_shift_counts_as_no_product() {
        let counts = |require_hardware, bad| {
            let shift = Shift { good: "GOOD".to_owned(), bad, lasts: Duration::from_secs(3600) };
            let production = Production { require_hardware, shift: Some(shift) };
            ["OTHER", "GOOD", "BAD", "HR:MOCK:1"].map(|serial| production.counts(serial))
        };
        assert_eq!(counts(true, Bad::Unit("BAD".to_owned())), [true, false, false, false]);
        assert_eq!(counts(true, Bad::Mock), [true, false, true, false]);
        assert_eq!(counts(false, Bad::Mock), [false; 4]);
    }
}
