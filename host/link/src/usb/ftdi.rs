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

    /// What the pins are for. The EEPROM decides, and the target must not contradict it.
    fn decide(&self, options: &UsbOptions) -> Result<Ready, UsbError> {
        let found = channel_mode(self.chip, self.channel, &self.read_eeprom()?);
        let (name, channel) = (self.name.to_owned(), self.channel.letter());
        let stored = match found.mode() {
            Some(ChannelMode::Uart | ChannelMode::Opto) => Some(Mode::Uart),
            Some(ChannelMode::Fifo) => Some(Mode::Fifo),
            None => None,
            Some(_) => return Err(UsbError::NoMode { name, channel, found: found.to_string() }),
        };
        let mode = match (options.mode, stored) {
            (Some(wanted), Some(stored)) if wanted != stored => {
                let (found, wanted) = (found.to_string(), wanted.name());
                return Err(UsbError::OtherMode { name, channel, found, wanted });
            }
            (Some(mode), _) | (None, Some(mode)) => mode,
            (None, None) => return Err(UsbError::NoMode { name, channel, found: found.to_string() }),
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

    use super::*;

    /// A chip that records requests, has a blank EEPROM, refuses one request, and sends what it `says`.
    #[derive(Default)]
    pub(in crate::usb) struct Noting {
        pub(in crate::usb) packet: Option<usize>,
        pub(in crate::usb) says: Mutex<VecDeque<Vec<u8>>>,
        requests: Mutex<Vec<(u8, u16, u16)>>,
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

        fn request_word(&self, request: u8, _: u16, _: u16) -> Result<u16, UsbFailure> {
            if self.refused == Some(request) { Err(UsbFailure::Refused) } else { Ok(0xffff) }
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

    #[test]
    fn what_is_not_known_is_not_guessed() {
        let chip = Noting { refused: Some(READ_EEPROM), ..Noting::default() };
        assert!(matches!(make_ready(&chip, Chip::Ft2232h, "usb"), Err(UsbError::NoMode { .. })));
    }
}
