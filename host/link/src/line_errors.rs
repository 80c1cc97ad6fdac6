//! Errors that the chip at a link's near end sees on its line.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Errors on the chip's pins, counted in packets that report them, or by the driver of a serial port.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineErrors {
    /// Bytes were lost because the host did not fetch them in time.
    pub overrun: u64,
    /// A parity bit was wrong.
    pub parity: u64,
    /// A stop bit was missing: the rates differ, or the line is poor.
    pub framing: u64,
    /// The line was low for longer than a byte: the board is off or resets.
    pub breaks: u64,
}

/// Saturates: a damaged recording may hold any counts.
impl std::ops::AddAssign for LineErrors {
    fn add_assign(&mut self, more: Self) {
        self.overrun = self.overrun.saturating_add(more.overrun);
        self.parity = self.parity.saturating_add(more.parity);
        self.framing = self.framing.saturating_add(more.framing);
        self.breaks = self.breaks.saturating_add(more.breaks);
    }
}

impl LineErrors {
    /// Their total.
    #[must_use]
    pub fn sum(self) -> u64 {
        [self.parity, self.framing, self.breaks].into_iter().fold(self.overrun, u64::saturating_add)
    }

    /// What to do about them if nothing could be judged.
    #[must_use]
    pub fn advice(self) -> Option<&'static str> {
        match self {
            // A held line lacks stop bits, too, and a USB chip tells of both; a wrong rate makes some of the bytes look like one.
            Self { breaks: breaks @ 1.., framing, .. } if breaks >= framing => {
                Some("The chip sees the board hold its line low: check power and bitstream.")
            }
            Self { framing: 1.., .. } => Some(
                "The chip sees bytes without a stop bit: check that `baud=` is the board's rate, and the line.",
            ),
            Self { overrun: 1.., .. } => Some(
                "The chip lost bytes that nobody fetched: give it a USB port of its own, without a hub or a virtual machine \
                 between, and use flow=rtscts if the board drives CTS, which a ULX3S does not.",
            ),
            Self { parity: 1.., .. } => {
                Some("The chip sees wrong parity: the board must send eight bits without.")
            }
            _ => None,
        }
    }

    /// Counts the errors that a chip's line status names.
    pub(crate) fn count(&mut self, line_status: u8) {
        let bit = |mask: u8| u64::from(line_status & mask != 0);
        // Bit 7 only says that some error is in the receive FIFO.
        self.overrun += bit(0x02);
        self.parity += bit(0x04);
        self.framing += bit(0x08);
        self.breaks += bit(0x10);
    }
}

impl fmt::Display for LineErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { overrun, parity, framing, breaks } = self;
        let named = [(overrun, "overrun"), (parity, "parity"), (framing, "framing"), (breaks, "break")];
        let some = named.into_iter().filter(|(count, _)| **count > 0);
        let words: Vec<String> = some.map(|(count, name)| format!("{count} {name}")).collect();
        f.write_str(&if words.is_empty() { "none".to_owned() } else { words.join(", ") })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chip that sees a held line tells of a missing stop bit with it.
    #[test]
    fn a_line_that_is_held_low_is_told_from_a_wrong_rate() {
        let advice =
            |framing, breaks| LineErrors { framing, breaks, overrun: 1, parity: 1 }.advice().unwrap();
        for (framing, breaks) in [(0, 1), (5, 5)] {
            assert!(advice(framing, breaks).contains("hold its line low"), "{framing}, {breaks}");
        }
        for (framing, breaks) in [(1, 0), (5, 2)] {
            assert!(advice(framing, breaks).contains("without a stop bit"), "{framing}, {breaks}");
        }
    }
}
