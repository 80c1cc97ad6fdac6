//! The options of a `serial:PATH` target.

use super::boards::{BOARDS, SerialBoard};
use crate::OpenError;
use crate::options::{choice, positive, read, set};
use crate::target::Target;

const KNOWN: &str = "board=minispartan6plus or board=ulx3s, baud=RATE, flow=rtscts or flow=none, dtr=on or dtr=off, and \
                     beside flow=none rts=on or rts=off";

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
        let mut named = None;
        read(target, KNOWN, |key, value| {
            key != "board" || set(&mut named, SerialBoard::named(value).map(Some))
        })?;
        let SerialBoard { baud, rts_cts, .. } = named.unwrap_or(BOARDS[0]);
        let mut options = Self { baud, rts_cts, dtr: true, rts: true };
        read(target, KNOWN, |key, value| match key {
            "board" => true,
            "baud" => set(&mut options.baud, positive(value)),
            "flow" => set(&mut options.rts_cts, choice(value, "rtscts", "none")),
            "dtr" => set(&mut options.dtr, choice(value, "on", "off")),
            "rts" => set(&mut options.rts, choice(value, "on", "off")),
            _ => false,
        })?;
        if let Some(board) = named {
            options.check(target, board)?;
        }
        // RTS can be set only without flow control.
        let allowed = |key: &str, _: &str| key != "rts" || !options.rts_cts;
        read(target, KNOWN, allowed)?;
        Ok(options)
    }

    /// Refuses an option of `target` that says something else than the `board` that it names.
    fn check(self, target: &Target, board: SerialBoard) -> Result<(), OpenError> {
        let wrong = match (self.baud == board.baud, self.rts_cts == board.rts_cts) {
            (true, true) => return Ok(()),
            (false, _) => "baud",
            (true, false) => "flow",
        };
        // A later option replaces an earlier one.
        let option = target.options.iter().rfind(|(key, _)| key == wrong);
        let option = option.map_or_else(|| wrong.to_owned(), |(key, value)| format!("{key}={value}"));
        let (board, meaning) = (board.name, board.options());
        Err(OpenError::OtherBoard { option, board, meaning })
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

    /// The rates and lines are those of the boards' pages.
    #[test]
    fn a_board_stands_for_its_rate_and_its_flow_control() {
        for (board, options) in [
            ("board=ulx3s", "baud=3000000,flow=none"),
            ("board=ulx3s,rts=off", "baud=3000000,flow=none,rts=off"),
            ("flow=none,board=ulx3s,baud=3000000", "baud=3000000,flow=none"),
            ("board=minispartan6plus", "baud=12000000,flow=rtscts"),
        ] {
            let [named, written] = [board, options].map(|it| parse(&format!("serial:/dev/x,{it}")).unwrap());
            assert_eq!(named, written, "{board}");
        }
        for board in BOARDS {
            assert!(KNOWN.contains(&format!("board={}", board.name)), "{board:?}");
        }
    }

    #[test]
    fn an_option_that_contradicts_the_board_is_refused_and_so_is_a_board_that_is_not_known() {
        let refused = |options| parse(&format!("serial:/dev/x,{options}")).unwrap_err().to_string();
        for (options, contradicts) in [
            (
                "board=ulx3s,baud=115200",
                "`baud=115200` contradicts `board=ulx3s`, which means baud=3000000,flow=none",
            ),
            ("flow=rtscts,board=ulx3s", "`flow=rtscts` contradicts `board=ulx3s`"),
            (
                "board=minispartan6plus,flow=none",
                "which means baud=12000000,flow=rtscts; leave one of the two out",
            ),
        ] {
            assert!(refused(options).contains(contradicts), "{}", refused(options));
        }
        let unknown = refused("board=ulx4,baud=1");
        assert!(
            unknown.starts_with(
                "`board=ulx4` is not an option of `serial`; it takes board=minispartan6plus or board=ulx3s"
            ),
            "{unknown}"
        );
    }
}
