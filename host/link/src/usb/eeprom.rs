//! The EEPROM next to a chip, which says what its channels are for. It is read, and never written.

use std::fmt;

use super::chip::{Channel, Chip};

/// Words that are read. An FT2232H's EEPROM has 64, 128 or 256, and the checksum is the last of the first 64 or 128.
pub(super) const WORDS: u16 = 128;

/// What a channel's pins are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChannelMode {
    Uart,
    Fifo,
    Opto,
    Cpu,
    Ft1248,
}

impl fmt::Display for ChannelMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Uart => "a UART",
            Self::Fifo => "a FIFO",
            Self::Opto => "a fast opto-isolated serial interface",
            Self::Cpu => "a processor bus",
            Self::Ft1248 => "an FT1248 bus",
        })
    }
}

/// What an EEPROM says about a channel, and how that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StoredMode {
    /// Its words say so.
    Stored(ChannelMode),
    /// Its words say something that is none of FTDI's modes.
    Foreign(u8),
    /// The chip ignores the EEPROM because it is blank, missing or has a wrong checksum, and treats its channels as UARTs.
    Ignored,
    /// It cannot be read.
    Unknown,
}

impl StoredMode {
    /// What the pins are for, if that is known.
    pub(super) fn mode(self) -> Option<ChannelMode> {
        match self {
            Self::Stored(mode) => Some(mode),
            Self::Ignored => Some(ChannelMode::Uart),
            Self::Foreign(_) | Self::Unknown => None,
        }
    }
}

impl fmt::Display for StoredMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stored(mode) => write!(f, "{mode} by its EEPROM"),
            Self::Foreign(code) => {
                write!(f, "set up by its EEPROM with the code {code}, which is no known mode")
            }
            Self::Ignored => f.write_str("a UART, since its EEPROM is blank or its checksum wrong"),
            Self::Unknown => f.write_str("unknown, since its EEPROM cannot be read"),
        }
    }
}

/// What `words` say about `channel` of an FT2232H or FT232H. Fewer than [`WORDS`] mean that the EEPROM cannot be read.
pub(super) fn channel_mode(chip: Chip, channel: Channel, words: &[u16]) -> StoredMode {
    if words.len() < usize::from(WORDS) {
        return StoredMode::Unknown;
    }
    if !is_valid(words) {
        return StoredMode::Ignored;
    }
    let code = words[0].to_le_bytes()[usize::from(channel.0)];
    let code = if chip == Chip::Ft232h { code & 0x0f } else { code & 0x07 };
    match code {
        0 => StoredMode::Stored(ChannelMode::Uart),
        1 => StoredMode::Stored(ChannelMode::Fifo),
        2 => StoredMode::Stored(ChannelMode::Opto),
        4 => StoredMode::Stored(ChannelMode::Cpu),
        8 => StoredMode::Stored(ChannelMode::Ft1248),
        code => StoredMode::Foreign(code),
    }
}

/// Whether the checksum matches, either of an EEPROM of 64 words, whose contents repeat, or of one with 128 or more.
fn is_valid(words: &[u16]) -> bool {
    [64, 128].into_iter().any(|length| {
        let (content, last) = words[..length].split_at(length - 1);
        content.iter().fold(0xaaaa_u16, |sum, word| (sum ^ word).rotate_left(1)) == last[0]
    }) && words.iter().any(|&word| word != 0xffff)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const B: Channel = Channel(1);

    /// An EEPROM of `length` words, repeated up to 128 words. The first word is `first`.
    pub(in crate::usb) fn words(first: u16, length: usize) -> Vec<u16> {
        let mut words = vec![0x0403; length];
        words[0] = first;
        let (last, content) = words.split_last_mut().unwrap();
        *last = content.iter().fold(0xaaaa, |sum: u16, word| (sum ^ *word).rotate_left(1));
        words.into_iter().cycle().take(128).collect()
    }

    #[test]
    fn each_channel_has_a_byte_of_its_own() {
        // setmode.c of the miniSpartan6+: 0x0101 is FIFO, 0x0801 is UART at B with the driver's bit.
        for length in [64, 128] {
            let stored = |first| channel_mode(Chip::Ft2232h, B, &words(first, length));
            assert_eq!(stored(0x0101), StoredMode::Stored(ChannelMode::Fifo));
            assert_eq!(stored(0x0801), StoredMode::Stored(ChannelMode::Uart));
            assert_eq!(stored(0x0200), StoredMode::Stored(ChannelMode::Opto));
            assert_eq!(stored(0x0400), StoredMode::Stored(ChannelMode::Cpu));
            assert_eq!(channel_mode(Chip::Ft2232h, Channel(0), &words(0x0801, length)), stored(0x0101));
        }
    }

    /// libftdi's ftdi.h: CHANNEL_IS_CPU is 4, CHANNEL_IS_FT1284 8, and DRIVER_VCPH 0x10, since its place is taken.
    #[test]
    fn an_ft232h_has_a_bit_more() {
        let stored = |first| channel_mode(Chip::Ft232h, Channel(0), &words(first, 128));
        for (code, mode) in [
            (0, ChannelMode::Uart),
            (1, ChannelMode::Fifo),
            (2, ChannelMode::Opto),
            (4, ChannelMode::Cpu),
            (8, ChannelMode::Ft1248),
        ] {
            assert_eq!(stored(code), StoredMode::Stored(mode), "{code}");
            assert_eq!(stored(0x10 | code), StoredMode::Stored(mode), "{code}");
        }
    }

    /// libftdi's ftdi.c, bit2type: no other value is one of FTDI's.
    #[test]
    fn an_eeprom_that_was_read_is_not_called_unreadable() {
        for (chip, code) in [(Chip::Ft2232h, 3), (Chip::Ft2232h, 7), (Chip::Ft232h, 12)] {
            let stored = channel_mode(chip, Channel(0), &words(code, 64));
            assert_eq!(stored.mode(), None, "{code}");
            let words = stored.to_string();
            assert!(words.contains(&format!("code {code}")) && !words.contains("cannot be read"), "{words}");
        }
    }

    #[test]
    fn a_chip_ignores_an_eeprom_that_is_blank_or_spoilt() {
        assert_eq!(channel_mode(Chip::Ft2232h, B, &[0xffff; 128]), StoredMode::Ignored);
        let mut spoilt = words(0x0101, 64);
        spoilt[1] ^= 1;
        assert_eq!(channel_mode(Chip::Ft2232h, B, &spoilt), StoredMode::Ignored);
        assert_eq!(StoredMode::Ignored.mode(), Some(ChannelMode::Uart));
    }

    #[test]
    fn what_cannot_be_read_is_not_guessed() {
        assert_eq!(channel_mode(Chip::Ft2232h, B, &[]), StoredMode::Unknown);
    }
}
