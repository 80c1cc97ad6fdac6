//! FTDI's requests, and the order in which a channel is made ready.

use super::chip::{Channel, Chip};
use super::eeprom::{ChannelMode, WORDS, channel_mode};
use super::error::UsbError;
use super::options::{Mode, UsbOptions};
use super::transport::{Transport, UsbFailure};

const RESET: u8 = 0;
const MODEM: u8 = 1;
const FLOW: u8 = 2;
const BAUD: u8 = 3;
const DATA: u8 = 4;
const LATENCY: u8 = 9;
const BIT_MODE: u8 = 11;
const READ_EEPROM: u8 = 0x90;

/// Values of [`RESET`]: the channel, the bytes to the board, the bytes to the host. Old libraries swapped the last two, which
/// does not matter, since all are reset.
const RESETS: [u16; 3] = [0, 1, 2];

/// Both modem lines on, and the bits that select them.
const DTR_AND_RTS_ON: u16 = 0x0303;

const RTS_CTS: u16 = 0x0100;

const EIGHT_BITS: u16 = 8;

/// What a channel was made ready for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ready {
    Fifo,
    /// With `handshake`, RTS and CTS stop the other side.
    Uart {
        baud: u32,
        handshake: bool,
    },
}

/// A channel of a chip, called `name` in errors.
pub(super) struct Ftdi<'a> {
    pub(super) transport: &'a dyn Transport,
    pub(super) chip: Chip,
    pub(super) channel: Channel,
    pub(super) name: &'a str,
}

impl Ftdi<'_> {
    /// Makes the channel ready, and drops the bytes that were under way.
    pub(super) fn make_ready(&self, options: &UsbOptions) -> Result<Ready, UsbError> {
        let ready = self.decide(options)?;
        let index = self.chip.index(self.channel);
        for what in RESETS {
            self.request("resetting the chip", RESET, what, index)?;
        }
        self.leave_special_modes(index)?;
        self.request("setting the latency timer", LATENCY, options.latency.into(), index)?;
        if let Ready::Uart { baud, handshake } = ready {
            self.set_up_line(baud, handshake, index)?;
        }
        Ok(ready)
    }

    /// What the channel is to be made ready for.
    fn decide(&self, options: &UsbOptions) -> Result<Ready, UsbError> {
        let mode = match (self.chip, options.mode) {
            (Chip::Ft2232h | Chip::Ft232h, wanted) => self.mode_beside_eeprom(wanted)?,
            (Chip::Ft4232h, Some(Mode::Fifo)) => {
                return Err(UsbError::NoFifo { chip: self.chip.name(), name: self.name.to_owned() });
            }
            (Chip::Ft4232h, _) => Mode::Uart,
            // An FT245R or FT240X, which is a FIFO, has the product id of an FT232R or FT231X.
            (Chip::FullSpeed, wanted) => wanted.unwrap_or(Mode::Uart),
        };
        match (mode, options.baud) {
            (Mode::Fifo, Some(_)) => Err(UsbError::BaudOfFifo),
            (Mode::Fifo, None) => Ok(Ready::Fifo),
            (Mode::Uart, baud) => {
                let baud = baud.unwrap_or_else(|| self.chip.speed().fastest());
                self.divisor(baud).map(|_| Ready::Uart { baud, handshake: options.handshake })
            }
        }
    }

    /// What the pins are for. The EEPROM decides, and the target must not contradict it.
    fn mode_beside_eeprom(&self, wanted: Option<Mode>) -> Result<Mode, UsbError> {
        let found = channel_mode(self.chip, self.channel, &self.read_eeprom()?);
        let stored = found.mode();
        let (name, channel, found) = (self.name.to_owned(), self.channel.letter(), found.to_string());
        let stored = match stored {
            Some(ChannelMode::Uart) => Some(Mode::Uart),
            Some(ChannelMode::Fifo) => Some(Mode::Fifo),
            Some(ChannelMode::Opto | ChannelMode::Cpu | ChannelMode::Ft1248) => {
                return Err(UsbError::UnusableMode { name, channel, found });
            }
            None => None,
        };
        match (wanted, stored) {
            (Some(wanted), Some(stored)) if wanted != stored => {
                Err(UsbError::OtherMode { name, channel, found, wanted: wanted.name() })
            }
            (Some(mode), _) | (None, Some(mode)) => Ok(mode),
            (None, None) => Err(UsbError::NoMode { name, channel, found }),
        }
    }

    /// The EEPROM's words; none if the chip refuses to read them.
    fn read_eeprom(&self) -> Result<Vec<u16>, UsbError> {
        let words: Result<Vec<u16>, UsbFailure> =
            (0..WORDS).map(|address| self.transport.request_word(READ_EEPROM, 0, address)).collect();
        match words {
            Err(UsbFailure::Refused) => Ok(Vec::new()),
            words => words.map_err(|source| self.failed("reading the chip's EEPROM", source)),
        }
    }

    /// A previous program may have left the channel in bit-bang mode. A chip without such modes refuses the request.
    fn leave_special_modes(&self, index: u16) -> Result<(), UsbError> {
        match self.transport.request(BIT_MODE, 0, index) {
            Err(UsbFailure::Refused) if !self.chip.is_high_speed() => Ok(()),
            done => done.map_err(|source| self.failed("setting the bit mode", source)),
        }
    }

    fn set_up_line(&self, baud: u32, handshake: bool, index: u16) -> Result<(), UsbError> {
        let divisor = self.divisor(baud)?;
        let high = (divisor >> 16) as u16;
        let baud_index = if self.chip.is_high_speed() { high << 8 | index } else { high };
        self.request("setting the baud rate", BAUD, divisor as u16, baud_index)?;
        self.request("setting the data format", DATA, EIGHT_BITS, index)?;
        let flow = if handshake { RTS_CTS } else { 0 };
        self.request("setting the handshake", FLOW, 0, flow | index)?;
        self.request("setting the modem lines", MODEM, DTR_AND_RTS_ON, index)
    }

    fn divisor(&self, baud: u32) -> Result<u32, UsbError> {
        let chip = self.chip.name();
        self.chip.speed().divisor(baud).map_err(|nearest| UsbError::Rate { chip, baud, nearest })
    }

    fn request(&self, doing: &'static str, request: u8, value: u16, index: u16) -> Result<(), UsbError> {
        self.transport.request(request, value, index).map_err(|source| self.failed(doing, source))
    }

    fn failed(&self, doing: &'static str, source: UsbFailure) -> UsbError {
        UsbError::Transfer { name: self.name.to_owned(), doing, source }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::VecDeque;
    use std::sync::Mutex;
    use std::time::Duration;

    use super::super::eeprom::tests::words;
    use super::*;

    /// A chip that records requests, has a blank EEPROM unless another is given, refuses one request, and sends what it `says`.
    #[derive(Default)]
    pub(in crate::usb) struct Noting {
        pub(in crate::usb) packet: Option<usize>,
        pub(in crate::usb) says: Mutex<VecDeque<Vec<u8>>>,
        requests: Mutex<Vec<(u8, u16, u16)>>,
        eeprom: Option<Vec<u16>>,
        words_read: Mutex<usize>,
        refused: Option<u8>,
    }

    impl Noting {
        /// One whose EEPROM, if `is_kept`, cannot be read either, so that the target alone says what it is.
        pub(in crate::usb) fn without_eeprom(is_kept: bool) -> Self {
            Self { refused: is_kept.then_some(READ_EEPROM), ..Self::default() }
        }
    }

    impl Transport for Noting {
        fn packet(&self) -> Option<usize> {
            self.packet
        }

        fn request(&self, request: u8, value: u16, index: u16) -> Result<(), UsbFailure> {
            self.requests.lock().unwrap().push((request, value, index));
            if self.refused == Some(request) { Err(UsbFailure::Refused) } else { Ok(()) }
        }

        fn request_word(&self, request: u8, _: u16, index: u16) -> Result<u16, UsbFailure> {
            *self.words_read.lock().unwrap() += 1;
            let word = |words: &Vec<u16>| words[usize::from(index)];
            let word = self.eeprom.as_ref().map_or(0xffff, word);
            if self.refused == Some(request) { Err(UsbFailure::Refused) } else { Ok(word) }
        }

        fn read(&self, buffer: &mut [u8], _: Duration) -> Result<usize, UsbFailure> {
            let said = self.says.lock().unwrap().pop_front().unwrap_or_default();
            buffer[..said.len()].copy_from_slice(&said);
            Ok(said.len())
        }

        fn write(&self, bytes: &[u8], _: Duration) -> Result<usize, UsbFailure> {
            Ok(bytes.len())
        }
    }

    fn make_ready(transport: &Noting, chip: Chip, target: &str) -> Result<Ready, UsbError> {
        let options = UsbOptions::of(&target.parse().unwrap()).unwrap();
        Ftdi { transport, chip, channel: chip.usual_channel(), name: "usb:X" }.make_ready(&options)
    }

    #[test]
    fn a_uart_at_b_gets_these_requests() {
        let chip = Noting::default();
        let ready = make_ready(&chip, Chip::Ft2232h, "usb,baud=3000000").unwrap();
        assert_eq!(ready, Ready::Uart { baud: 3_000_000, handshake: true });
        // Request, wValue and wIndex as in AN232B-04 and libftdi's ftdi.h: channel B is index 2.
        let expected = [
            (0, 0, 2),
            (0, 1, 2),
            (0, 2, 2),
            (11, 0, 2),
            (9, 2, 2),
            (3, 4, 0x0202),
            (4, 8, 2),
            (2, 0, 0x0102),
            (1, 0x0303, 2),
        ];
        assert_eq!(*chip.requests.lock().unwrap(), expected);
    }

    #[test]
    fn a_fifo_has_no_line_to_set_up() {
        let chip = Noting { refused: Some(READ_EEPROM), ..Noting::default() };
        assert_eq!(make_ready(&chip, Chip::Ft232h, "usb,mode=fifo,latency=16").unwrap(), Ready::Fifo);
        assert_eq!(*chip.requests.lock().unwrap(), [(0, 0, 0), (0, 1, 0), (0, 2, 0), (11, 0, 0), (9, 16, 0)]);
    }

    #[test]
    fn a_chip_of_full_speed_may_lack_bit_modes() {
        let refusing = || Noting { refused: Some(BIT_MODE), ..Noting::default() };
        assert!(make_ready(&refusing(), Chip::FullSpeed, "usb").is_ok());
        assert!(matches!(
            make_ready(&refusing(), Chip::Ft2232h, "usb"),
            Err(UsbError::Transfer { doing: "setting the bit mode", source: UsbFailure::Refused, .. })
        ));
    }

    #[test]
    fn nothing_is_set_before_it_is_clear_that_all_can_be() {
        for target in ["usb,mode=fifo", "usb,baud=7000000"] {
            let chip = Noting::default();
            assert!(make_ready(&chip, Chip::Ft2232h, target).is_err(), "{target}");
            assert!(chip.requests.lock().unwrap().is_empty(), "{target}");
        }
    }

    /// A processor's bus and the fast serial interface for optocouplers, both at B, and an FT1248 bus: neither mode is theirs.
    #[test]
    fn a_channel_that_is_neither_uart_nor_fifo_is_to_be_set_up_anew() {
        for (chip, first) in [(Chip::Ft2232h, 0x0400), (Chip::Ft2232h, 0x0200), (Chip::Ft232h, 0x0008)] {
            for target in ["usb", "usb,mode=uart", "usb,mode=fifo"] {
                let device = Noting { eeprom: Some(words(first, 64)), ..Noting::default() };
                let refused = make_ready(&device, chip, target).unwrap_err().to_string();
                assert!(refused.contains("FT_PROG") && !refused.contains("say mode="), "{refused}");
                assert!(device.requests.lock().unwrap().is_empty());
            }
        }
    }

    /// FT245R and FT240X have the product ids of FT232R and FT231X, and are FIFOs.
    #[test]
    fn of_a_chip_of_full_speed_the_target_says_what_it_is() {
        let uart = Ready::Uart { baud: 3_000_000, handshake: true };
        for (target, ready) in [("usb", uart), ("usb,mode=uart", uart), ("usb,mode=fifo", Ready::Fifo)] {
            let chip = Noting::default();
            assert_eq!(make_ready(&chip, Chip::FullSpeed, target).unwrap(), ready, "{target}");
            assert_eq!(*chip.words_read.lock().unwrap(), 0, "{target}");
        }
    }

    #[test]
    fn a_chip_of_four_channels_has_no_fifo() {
        let chip = Noting::default();
        let refused = make_ready(&chip, Chip::Ft4232h, "usb,mode=fifo").unwrap_err().to_string();
        assert!(refused.contains("has no FIFO") && !refused.contains("EEPROM"), "{refused}");
        assert!(make_ready(&chip, Chip::Ft4232h, "usb").is_ok());
        assert_eq!(*chip.words_read.lock().unwrap(), 0);
    }

    #[test]
    fn what_is_not_known_is_not_guessed() {
        let chip = Noting { refused: Some(READ_EEPROM), ..Noting::default() };
        assert!(matches!(make_ready(&chip, Chip::Ft2232h, "usb"), Err(UsbError::NoMode { .. })));
    }
}
