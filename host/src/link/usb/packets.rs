//! Packets to the host: two status bytes in front of every one, whatever the transfer's length.

use std::fmt;

use serde::{Deserialize, Serialize};

const STATUS: usize = 2;

/// What the chip says went wrong on its pins, counted in packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineErrors {
    /// Bytes got lost, since the host did not fetch them in time.
    pub overrun: u64,
    /// A parity bit was wrong.
    pub parity: u64,
    /// A stop bit was missing: the rates differ, or the line is poor.
    pub framing: u64,
    /// The line was low for longer than a byte: the board is off or resets.
    pub breaks: u64,
}

impl std::ops::AddAssign for LineErrors {
    fn add_assign(&mut self, more: Self) {
        self.overrun += more.overrun;
        self.parity += more.parity;
        self.framing += more.framing;
        self.breaks += more.breaks;
    }
}

impl LineErrors {
    /// How many there are in all.
    #[must_use]
    pub fn sum(self) -> u64 {
        self.overrun + self.parity + self.framing + self.breaks
    }

    /// What to do about them when nothing could be judged.
    #[must_use]
    pub fn advice(self) -> Option<&'static str> {
        match self {
            Self { framing: 1.., .. } => Some(
                "The chip sees bytes without a stop bit: check that `baud=` is the board's rate, and the line.",
            ),
            Self { breaks: 1.., .. } => {
                Some("The chip sees the board hold its line low: check power and bitstream.")
            }
            Self { overrun: 1.., .. } => Some(
                "The chip lost bytes that nobody fetched: use flow=rtscts, or a lower rate if the board has no RTS.",
            ),
            Self { parity: 1.., .. } => {
                Some("The chip sees wrong parity: the board must send eight bits without.")
            }
            _ => None,
        }
    }

    fn count(&mut self, line_status: u8) {
        let bit = |mask: u8| u64::from(line_status & mask != 0);
        // Bit 7 is set while any error lies in the receive FIFO, and names none.
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

/// Appends the data of `transfer`, which is made of packets of `packet` bytes and at most one shorter at its end, and counts
/// the line errors of each packet if it `is_line`.
pub(super) fn strip(
    transfer: &[u8],
    packet: usize,
    data: &mut Vec<u8>,
    is_line: bool,
    errors: &mut LineErrors,
) {
    for packet in transfer.chunks(packet) {
        if let Some((status, rest)) = packet.split_at_checked(STATUS) {
            if is_line {
                errors.count(status[1]);
            }
            data.extend_from_slice(rest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripped(transfer: &[u8], packet: usize) -> (Vec<u8>, LineErrors) {
        let (mut data, mut errors) = (Vec::new(), LineErrors::default());
        strip(transfer, packet, &mut data, true, &mut errors);
        (data, errors)
    }

    #[test]
    fn every_packet_of_a_transfer_loses_its_status() {
        let mut transfer = vec![1; 512 + 512 + 5];
        for start in [0, 512, 1024] {
            transfer[start..start + 2].copy_from_slice(&[0xb1, 0x60]);
        }
        assert_eq!(stripped(&transfer, 512), (vec![1; 510 + 510 + 3], LineErrors::default()));
    }

    #[test]
    fn packets_of_full_speed_are_shorter() {
        assert_eq!(stripped(&[0; 64 + 3], 64).0.len(), 62 + 1);
    }

    #[test]
    fn status_alone_or_less_is_no_data() {
        assert!(stripped(&[0xb1, 0x60], 512).0.is_empty());
        assert!(stripped(&[0xb1], 512).0.is_empty());
        assert!(stripped(&[], 512).0.is_empty());
    }

    #[test]
    fn line_errors_of_every_packet_count() {
        let mut transfer = vec![0; 1024 + 2];
        (transfer[1], transfer[513], transfer[1025]) = (0x60 | 0x02, 0x60 | 0x08 | 0x80, 0x60 | 0x14);
        let expected = LineErrors { overrun: 1, parity: 1, framing: 1, breaks: 1 };
        assert_eq!(stripped(&transfer, 512).1, expected);
        assert_eq!(expected.sum(), 4);
        assert_eq!(expected.to_string(), "1 overrun, 1 parity, 1 framing, 1 break");
        assert!(expected.advice().unwrap().contains("baud="));
        assert_eq!(
            (LineErrors::default().to_string().as_str(), LineErrors::default().advice()),
            ("none", None)
        );
    }

    #[test]
    fn a_fifo_has_no_line_to_have_errors() {
        let mut errors = LineErrors::default();
        strip(&[0xb1, 0x1e, 7], 512, &mut Vec::new(), false, &mut errors);
        assert_eq!(errors, LineErrors::default());
    }
}
