//! The chip: descriptors, requests, two channels.

use crate::channel::Channel;
use crate::descriptors::{DEVICE, LANGUAGES, configuration, string};
use crate::eeprom::{ChannelMode, Eeprom};
use crate::far_end::FarEnd;

/// What a chip is made with.
#[derive(Clone, Debug)]
pub struct ChipOptions {
    /// Its serial number.
    pub serial: String,
    /// Its product string.
    pub product: String,
    /// Its EEPROM.
    pub eeprom: Eeprom,
    /// The rate at which the board at channel B talks; none for a board that follows the chip's rate.
    pub board_baud: Option<u32>,
    /// What already is in channel B's FIFO.
    pub stale: Vec<u8>,
    /// Whether it is plugged in where USB is not faster than full speed.
    pub is_slowed: bool,
}

impl Default for ChipOptions {
    /// A chip with a FIFO board at channel B.
    fn default() -> Self {
        Self {
            serial: "HR000001".to_owned(),
            product: "miniSpartan6+".to_owned(),
            eeprom: Eeprom::new(ChannelMode::Uart, ChannelMode::Fifo),
            board_baud: None,
            stale: Vec::new(),
            is_slowed: false,
        }
    }
}

impl ChipOptions {
    /// Bytes of a packet.
    fn packet(&self) -> u16 {
        if self.is_slowed { 64 } else { 512 }
    }
}

/// A request at endpoint 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    kind: u8,
    request: u8,
    value: u16,
    index: u16,
    pub(crate) length: usize,
}

impl From<[u8; 8]> for Setup {
    fn from(bytes: [u8; 8]) -> Self {
        let word = |at| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        Self { kind: bytes[0], request: bytes[1], value: word(2), index: word(4), length: word(6).into() }
    }
}

/// An FT2232H.
pub struct Chip {
    options: ChipOptions,
    pub(crate) channels: [Channel; 2],
    configuration: u8,
}

impl Chip {
    /// A chip with `board` at its channel B.
    #[must_use]
    pub fn new(options: ChipOptions, board: Box<dyn FarEnd>) -> Self {
        let [a, b] = if options.eeprom == Eeprom::BLANK {
            [ChannelMode::Uart; 2]
        } else {
            options.eeprom.0[0].to_le_bytes().map(|code| match code & 7 {
                1 => ChannelMode::Fifo,
                2 => ChannelMode::Opto,
                4 => ChannelMode::Cpu,
                _ => ChannelMode::Uart,
            })
        };
        let packet = options.packet().into();
        let mut channels =
            [Channel::new(a, packet, None, None), Channel::new(b, packet, Some(board), options.board_baud)];
        channels[1].put_in_fifo(&options.stale);
        Self { options, channels, configuration: 0 }
    }

    /// Whether it is plugged in where USB is not faster than full speed.
    pub(crate) fn is_slowed(&self) -> bool {
        self.options.is_slowed
    }

    /// The answer to a request, empty when the host asks for no data. None is a stall.
    pub(crate) fn control(&mut self, setup: Setup) -> Option<Vec<u8>> {
        match setup.kind {
            0x40 => self.vendor_out(setup).map(|()| Vec::new()),
            0xc0 => self.vendor_in(setup),
            _ => self.standard(setup),
        }
    }

    fn standard(&mut self, setup: Setup) -> Option<Vec<u8>> {
        match (setup.kind, setup.request) {
            (0x80, 0) | (0x81, 0) | (0x82, 0) => Some(vec![0, 0]),
            (0x80, 6) => self.descriptor(setup.value),
            (0x80, 8) => Some(vec![self.configuration]),
            (0x81, 10) => Some(vec![0]),
            (0x00, 9) if setup.value <= 1 => {
                self.configuration = setup.value as u8;
                Some(Vec::new())
            }
            // SET_INTERFACE knows one alternative setting only; the other clears a halt.
            (0x01, 11) if setup.value == 0 => Some(Vec::new()),
            (0x02, 1) => Some(Vec::new()),
            _ => None,
        }
    }

    fn descriptor(&self, value: u16) -> Option<Vec<u8>> {
        match value {
            0x0100 => Some(DEVICE.to_vec()),
            0x0200 => Some(configuration(self.options.packet()).to_vec()),
            0x0300 => Some(LANGUAGES.to_vec()),
            0x0301 => Some(string("FTDI")),
            0x0302 => Some(string(&self.options.product)),
            0x0303 => Some(string(&self.options.serial)),
            _ => None,
        }
    }

    /// The channel that the low byte of an index names, counted from 1; 0 means A, too.
    fn channel(&mut self, index: u16) -> Option<&mut Channel> {
        self.channels.get_mut(usize::from(index & 0xff).saturating_sub(1))
    }

    fn vendor_out(&mut self, setup: Setup) -> Option<()> {
        let Setup { value, index, .. } = setup;
        let both_are_fifos = self.options.eeprom.0[0] & 0x0707 == 0x0101;
        let channel = self.channel(index)?;
        match setup.request {
            // Reset, or drop what is on its way to the host.
            0 if value == 0 || value == 2 => channel.drop_bytes_to_host(),
            // Dropping what is on its way to the board does nothing, since the board takes it at once. Nor do modem lines, flow
            // control, and event and error characters change anything that a host could see here.
            0 if value == 1 => {}
            1 | 2 | 4 | 6 | 7 => {}
            3 => channel.set_divisor(u32::from(value) | u32::from(index >> 8) << 16),
            9 if value <= 255 => channel.set_latency(value as u8),
            // Reset and bit-banging. A synchronous FIFO takes up both channels, and only A can be it.
            11 if matches!(value >> 8, 0 | 1 | 4 | 0x10) => {}
            11 if value >> 8 == 0x40 && index & 0xff == 1 && both_are_fifos => {}
            // The EEPROM cannot be written, since nobody should.
            _ => return None,
        }
        Some(())
    }

    fn vendor_in(&mut self, setup: Setup) -> Option<Vec<u8>> {
        match setup.request {
            5 => Some(self.channel(setup.index)?.status().to_vec()),
            10 => Some(vec![self.channel(setup.index)?.latency()]),
            12 => self.channel(setup.index).map(|_| vec![0xff]),
            // 64 words, which repeat.
            0x90 => Some(self.options.eeprom.0[usize::from(setup.index & 63)].to_le_bytes().to_vec()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::far_end::Loopback;

    fn chip() -> Chip {
        Chip::new(ChipOptions::default(), Box::new(Loopback::default()))
    }

    fn request(kind: u8, request: u8, value: u16, index: u16) -> Setup {
        Setup { kind, request, value, index, length: 64 }
    }

    #[test]
    fn the_descriptors_are_as_long_as_they_say() {
        assert_eq!(usize::from(DEVICE[0]), DEVICE.len());
        let configuration = chip().control(request(0x80, 6, 0x0200, 0)).unwrap();
        assert_eq!(usize::from(configuration[2]), configuration.len());
        assert_eq!(chip().control(request(0x80, 6, 0x0301, 0)).unwrap(), b"\x0a\x03F\0T\0D\0I\0");
    }

    #[test]
    fn requests_are_answered_by_the_channel_that_they_name() {
        let mut chip = chip();
        assert_eq!(chip.control(request(0x40, 9, 2, 2)), Some(vec![]));
        assert_eq!(chip.control(request(0xc0, 10, 0, 2)), Some(vec![2]));
        assert_eq!(chip.control(request(0xc0, 10, 0, 1)), Some(vec![16]));
        assert_eq!(chip.control(request(0xc0, 0x90, 0, 0)), Some(vec![0, 1]));
        assert_eq!(chip.control(request(0xc0, 0x90, 0, 64)), Some(vec![0, 1]));
    }

    #[test]
    fn what_the_chip_does_not_know_stalls_and_so_does_a_write_of_the_eeprom() {
        for (kind, code, value, index) in [
            (0x40, 0x91, 0, 0),
            (0x40, 0x92, 0, 0),
            (0x40, 0x33, 0, 1),
            (0xc0, 10, 0, 3),
            (0x40, 11, 0x40ff, 2),
        ] {
            assert_eq!(chip().control(request(kind, code, value, index)), None, "{code:x}");
        }
    }
}
