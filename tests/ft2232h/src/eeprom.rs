//! The 93C46 next to the chip: 64 words that say what its channels are.

/// What a channel's pins are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ChannelMode {
    /// A serial line.
    Uart = 0,
    /// An asynchronous FIFO like that of the FT245.
    Fifo = 1,
    /// A synchronous serial interface for optocouplers, clocked by the board.
    Opto = 2,
    /// A bus for a processor.
    Cpu = 4,
}

/// The words of an EEPROM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Eeprom(pub [u16; 64]);

impl Eeprom {
    /// An EEPROM as it leaves the factory.
    pub const BLANK: Self = Self([0xffff; 64]);

    /// An EEPROM for these channels, with its checksum. The strings are in the descriptors alone.
    #[must_use]
    pub fn new(a: ChannelMode, b: ChannelMode) -> Self {
        let mut words = [0; 64];
        words[0] = a as u16 | (b as u16) << 8;
        words[1..6].copy_from_slice(&[0x0403, 0x6010, 0x0700, 0xfa80, 0x0000]);
        words[10] = 0x46;
        words[63] = checksum(&words[..63]);
        Self(words)
    }
}

fn checksum(words: &[u16]) -> u16 {
    words.iter().fold(0xaaaa, |sum, word| (sum ^ word).rotate_left(1))
}
