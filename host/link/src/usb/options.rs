//! The options of a `usb` target.

use crate::options::{choice, positive, read, set};
use crate::{OpenError, Target};

const KNOWN: &str = "channel=a to channel=d, mode=fifo or mode=uart, latency=1 to latency=255 (milliseconds), and unless \
                     mode=fifo is among them baud=RATE, and flow=rtscts or flow=none";

/// What the pins of a channel are used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    Fifo,
    Uart,
}

impl Mode {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Fifo => "fifo",
            Self::Uart => "uart",
        }
    }
}

/// What a target asks for; none where it does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct UsbOptions {
    /// Counted from 0 for A.
    pub(super) channel: Option<u8>,
    pub(super) mode: Option<Mode>,
    pub(super) baud: Option<u32>,
    /// Whether RTS and CTS stop the other side.
    pub(super) handshake: bool,
    /// Milliseconds that the chip waits before it sends a packet that is not full. 1 is too short for some FIFOs in FPGAs, which
    /// then lose bytes.
    pub(super) latency: u8,
}

impl UsbOptions {
    pub(super) fn of(target: &Target) -> Result<Self, OpenError> {
        let mut options = Self { channel: None, mode: None, baud: None, handshake: true, latency: 2 };
        let channel = |letter: &str| ["a", "b", "c", "d"].iter().position(|&known| known == letter);
        let mode = |name: &str| [Mode::Fifo, Mode::Uart].into_iter().find(|mode| mode.name() == name);
        read(target, KNOWN, |key, value| match key {
            "channel" => set(&mut options.channel, channel(value).map(|at| Some(at as u8))),
            "mode" => set(&mut options.mode, mode(value).map(Some)),
            "baud" => set(&mut options.baud, positive(value).map(Some)),
            "flow" => set(&mut options.handshake, choice(value, "rtscts", "none")),
            "latency" => set(&mut options.latency, positive(value)),
            _ => false,
        })?;
        let of_line = |key: &str| matches!(key, "baud" | "flow");
        read(target, KNOWN, |key, _| options.mode != Some(Mode::Fifo) || !of_line(key))?;
        Ok(options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(target: &str) -> Result<UsbOptions, OpenError> {
        UsbOptions::of(&target.parse().unwrap())
    }

    #[test]
    fn options_are_read() {
        let default = UsbOptions { channel: None, mode: None, baud: None, handshake: true, latency: 2 };
        assert_eq!(parse("usb").unwrap(), default);
        let all = "usb:X,channel=a,mode=uart,baud=3000000,flow=none,latency=16";
        let expected = UsbOptions {
            channel: Some(0),
            mode: Some(Mode::Uart),
            baud: Some(3_000_000),
            handshake: false,
            latency: 16,
        };
        assert_eq!(parse(all).unwrap(), expected);
    }

    /// It has no line that could have a rate or a handshake.
    #[test]
    fn a_fifo_has_no_options_of_a_line() {
        for wrong in ["baud=9600", "flow=none", "flow=rtscts"] {
            for target in [format!("usb,mode=fifo,{wrong}"), format!("usb,{wrong},mode=fifo")] {
                let refused = parse(&target);
                assert!(
                    matches!(&refused, Err(OpenError::Option { option, .. }) if option == wrong),
                    "{target}: {refused:?}"
                );
            }
        }
        assert!(parse("usb,mode=fifo,latency=16,channel=a").is_ok());
    }

    #[test]
    fn what_is_no_option_is_refused() {
        for wrong in
            ["channel=e", "mode=spi", "baud=0", "baud=x", "flow=xon", "latency=0", "latency=256", "speed=1"]
        {
            assert!(
                matches!(parse(&format!("usb,{wrong}")), Err(OpenError::Option { option, .. }) if option == wrong),
                "{wrong}"
            );
        }
    }
}
