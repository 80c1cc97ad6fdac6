//! The pieces into which stuffing cuts packets, for boards that get one of them wrong.

/// The code of a piece of 254 bytes, behind which no zero is implied (WIRE.md, 1).
const FULL: u8 = 0xff;
/// The code of an empty piece.
const EMPTY: u8 = 1;

/// Looks for empty pieces behind full ones, each of which stands for a zero, in a stream of bytes.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    /// Bytes of the present piece that are to come.
    left: u8,
    /// The code of the present piece, or 0 before the first one of a packet.
    code: u8,
}

impl Pieces {
    /// Takes the empty pieces behind full ones out of `bytes`, which follow those before.
    pub(super) fn without_zeros(&mut self, bytes: &mut Vec<u8>) {
        bytes.retain(|&byte| !self.is_zero(byte));
    }

    fn is_zero(&mut self, byte: u8) -> bool {
        if byte == 0 {
            *self = Self::default();
        } else if self.left > 0 {
            self.left -= 1;
        } else {
            let before = std::mem::replace(&mut self.code, byte);
            self.left = byte - 1;
            return (before, byte) == (FULL, EMPTY);
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// WIRE.md, 1: a piece of 254 bytes has the code ff, and an empty one behind it stands for a zero.
    #[test]
    fn only_an_empty_piece_behind_a_full_one_is_taken_out_however_the_bytes_arrive() {
        let full = [&[0xff][..], &[1; 254]].concat();
        let packet = [&[0, 1, 2, 7][..], &full, &[1, 1, 2, 9, 0], &full, &[0, 1, 0]].concat();
        let right = [&[0, 1, 2, 7][..], &full, &[1, 2, 9, 0], &full, &[0, 1, 0]].concat();
        for at_once in [1, 100, packet.len()] {
            let mut pieces = Pieces::default();
            let mut left = Vec::new();
            for bytes in packet.chunks(at_once) {
                let mut bytes = bytes.to_vec();
                pieces.without_zeros(&mut bytes);
                left.append(&mut bytes);
            }
            assert_eq!(left, right, "{at_once}");
        }
    }
}
