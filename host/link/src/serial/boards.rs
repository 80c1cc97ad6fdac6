//! The boards that `board=NAME` of a `serial:PATH` target can name.

use crate::ftdi::Speed;

/// A board behind a serial port, and what it demands of the port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SerialBoard {
    /// The name of its folder in `fpga/boards`.
    pub name: &'static str,
    /// Bits a second, of which ten make a byte.
    pub baud: u32,
    /// Whether RTS and CTS lead to it.
    pub(super) rts_cts: bool,
}

/// All of them. A target that names none has the settings of the first.
pub(super) const BOARDS: [SerialBoard; 2] = [
    // The UART of an FT2232H.
    SerialBoard { name: "minispartan6plus", baud: 12_000_000, rts_cts: true },
    // An FT231X, of which only the lines for data lead to the FPGA.
    SerialBoard { name: "ulx3s", baud: 3_000_000, rts_cts: false },
];

impl SerialBoard {
    /// The board of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        BOARDS.into_iter().find(|board| board.name == name)
    }

    /// The one that runs at the fastest rate of such a chip.
    pub(crate) fn behind(chip: Speed) -> Option<Self> {
        BOARDS.into_iter().find(|board| board.baud == chip.fastest())
    }

    /// The options that say the same.
    pub(super) fn options(self) -> String {
        let flow = if self.rts_cts { "rtscts" } else { "none" };
        format!("baud={},flow={flow}", self.baud)
    }
}
