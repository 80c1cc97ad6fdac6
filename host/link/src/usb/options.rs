//! The options of a `usb` target.

use super::error::UsbError;
use crate::target::Target;

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

/// What a target asks for, as far as it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct UsbOptions {
    /// From 0 for A.
    pub(super) channel: Option<u8>,
    pub(super) mode: Option<Mode>,
    pub(super) baud: Option<u32>,
    /// Whether RTS and CTS stop the other side.
    pub(super) handshake: bool,
    /// Milliseconds that the chip waits before it sends a packet that is not full. One is too few for some FIFOs
    /// in FPGAs, which lose bytes then.
    pub(super) latency: u8,
}

impl UsbOptions {
    pub(super) fn of(target: &Target) -> Result<Self, UsbError> {
        let mut options = Self { channel: None, mode: None, baud: None, handshake: true, latency: 2 };
        for (key, value) in &target.options {
            let is_known = match (key.as_str(), value.as_str()) {
                ("channel", letter) => {
                    options.channel =
                        ["a", "b", "c", "d"].iter().position(|&known| known == letter).map(|at| at as u8);
                    options.channel.is_some()
                }
                ("mode", name) => {
                    options.mode = [Mode::Fifo, Mode::Uart].into_iter().find(|mode| mode.name() == name);
                    options.mode.is_some()
                }
                ("baud", rate) => {
                    options.baud = rate.parse().ok().filter(|&rate| rate > 0);
                    options.baud.is_some()
                }
                ("flow", choice @ ("rtscts" | "none")) => {
                    options.handshake = choice == "rtscts";
                    true
                }
                ("latency", milliseconds) => match milliseconds.parse() {
                    Ok(milliseconds @ 1..) => {
                        options.latency = milliseconds;
                        true
                    }
                    _ => false,
                },
                _ => false,
            };
            if !is_known {
                return Err(UsbError::Option(format!("{key}={value}")));
            }
        }
        Ok(options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(target: &str) -> Result<UsbOptions, UsbError> {
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

    #[test]
    fn what_is_no_option_is_refused() {
        for wrong in
            ["channel=e", "mode=spi", "baud=0", "baud=x", "flow=xon", "latency=0", "latency=256", "speed=1"]
        {
            assert!(
                matches!(parse(&format!("usb,{wrong}")), Err(UsbError::Option(text)) if text == wrong),
                "{wrong}"
            );
        }
    }
}
