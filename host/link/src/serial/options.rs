//! The options of a `serial:PATH` target.

use crate::OpenError;
use crate::options::{choice, positive, read, set};
use crate::target::Target;

const KNOWN: &str =
    "baud=RATE, flow=rtscts or flow=none, dtr=on or dtr=off, and beside flow=none rts=on or rts=off";

/// The rate of an FT2232H's UART, as on the miniSpartan6+.
const DEFAULT_BAUD: u32 = 12_000_000;

/// The settings of a serial port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SerialOptions {
    /// Bits a second, of which ten make a byte.
    pub(super) baud: u32,
    /// Whether RTS and CTS stop either side.
    pub(super) rts_cts: bool,
    /// The level of DTR while the port is open.
    pub(super) dtr: bool,
    /// The level of RTS if it is not used for flow control.
    pub(super) rts: bool,
}

impl SerialOptions {
    pub(super) fn parse(target: &Target) -> Result<Self, OpenError> {
        let mut options = Self { baud: DEFAULT_BAUD, rts_cts: true, dtr: true, rts: true };
        read(target, KNOWN, |key, value| match key {
            "baud" => set(&mut options.baud, positive(value)),
            "flow" => set(&mut options.rts_cts, choice(value, "rtscts", "none")),
            "dtr" => set(&mut options.dtr, choice(value, "on", "off")),
            "rts" => set(&mut options.rts, choice(value, "on", "off")),
            _ => false,
        })?;
        // RTS can be set only without flow control.
        let allowed = |key: &str, _: &str| key != "rts" || !options.rts_cts;
        read(target, KNOWN, allowed)?;
        Ok(options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<SerialOptions, OpenError> {
        SerialOptions::parse(&text.parse().unwrap())
    }

    #[test]
    fn options_are_read() {
        let default = SerialOptions { baud: 12_000_000, rts_cts: true, dtr: true, rts: true };
        assert_eq!(parse("serial:/dev/x").unwrap(), default);
        let other = SerialOptions { baud: 115_200, rts_cts: false, dtr: false, rts: false };
        assert_eq!(parse("serial:/dev/x,baud=115200,flow=none,dtr=off,rts=off").unwrap(), other);
    }

    #[test]
    fn what_is_no_option_is_refused() {
        for wrong in
            ["baud=0", "baud=fast", "flow=maybe", "dtr=1", "parity=even", "rts=off", "rts=on,flow=rtscts"]
        {
            assert!(
                matches!(parse(&format!("serial:/dev/x,{wrong}")), Err(OpenError::Option { .. })),
                "{wrong}"
            );
        }
    }
}
