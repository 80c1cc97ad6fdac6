//! Packets to the host. Each has two status bytes in front, whatever the transfer's length.

use crate::LineErrors;

const STATUS: usize = 2;

/// Appends the data of `transfer`, which consists of packets of `packet` bytes, the last of which may be shorter. Counts the line
/// errors of each packet with data if it `is_line`: chips repeat them in those that follow without.
pub(super) fn strip(
    transfer: &[u8],
    packet: usize,
    data: &mut Vec<u8>,
    is_line: bool,
    errors: &mut LineErrors,
) {
    for packet in transfer.chunks(packet) {
        if let Some((status, rest)) = packet.split_at_checked(STATUS) {
            if is_line && !rest.is_empty() {
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
    fn line_errors_of_every_packet_with_data_count() {
        let mut transfer = vec![0; 1024 + 3];
        (transfer[1], transfer[513], transfer[1025]) = (0x60 | 0x02, 0x60 | 0x08 | 0x80, 0x60 | 0x14);
        let expected = LineErrors { overrun: 1, parity: 1, framing: 1, breaks: 1 };
        assert_eq!(stripped(&transfer, 512).1, expected);
        assert_eq!(expected.sum(), 4);
        assert_eq!(expected.to_string(), "1 overrun, 1 parity, 1 framing, 1 break");
        assert!(expected.advice().unwrap().contains("hold its line low"));
        assert_eq!(
            (LineErrors::default().to_string().as_str(), LineErrors::default().advice()),
            ("none", None)
        );
    }

    /// Bits 1 to 4 of the line status of a 16550 (Texas Instruments' TL16C550C, "Line status register"), which FTDI's chips pass
    /// on.
    #[test]
    fn each_bit_of_the_line_status_is_an_error_of_its_own() {
        let none = LineErrors::default();
        for (bit, expected, advice) in [
            (1, LineErrors { overrun: 1, ..none }, "flow=rtscts"),
            (2, LineErrors { parity: 1, ..none }, "eight bits"),
            (3, LineErrors { framing: 1, ..none }, "baud="),
            (4, LineErrors { breaks: 1, ..none }, "power and bitstream"),
        ] {
            assert_eq!(stripped(&[0x01, 0x60 | 1 << bit, 7], 64).1, expected);
            assert_eq!(expected.sum(), 1);
            assert!(expected.advice().unwrap().contains(advice), "{expected}");
        }
    }

    /// A board without power sends nothing that anybody could fetch too late.
    #[test]
    fn a_line_that_is_held_low_is_looked_at_before_bytes_that_were_lost() {
        let errors = LineErrors { breaks: 1, overrun: 9, parity: 9, framing: 0 };
        assert!(errors.advice().unwrap().contains("power and bitstream"));
    }

    /// As Linux's driver for these chips has it (drivers/usb/serial/ftdi_sio.c, ftdi_process_packet).
    #[test]
    fn an_error_that_is_repeated_without_data_counts_once() {
        let packets = [[0x01, 0x60 | 0x08, 7].as_slice(), &[0x01, 0x60 | 0x08]];
        let mut errors = LineErrors::default();
        for packet in packets {
            strip(packet, 64, &mut Vec::new(), true, &mut errors);
        }
        assert_eq!(errors.sum(), 1);
    }

    #[test]
    fn a_fifo_has_no_line_to_have_errors() {
        let mut errors = LineErrors::default();
        strip(&[0xb1, 0x1e, 7], 512, &mut Vec::new(), false, &mut errors);
        assert_eq!(errors, LineErrors::default());
    }
}
