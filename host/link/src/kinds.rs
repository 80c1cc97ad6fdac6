//! Every kind of board that a target can name: how it is written, what it is, how it is opened, and where such boards are found.
//! A new kind is a line here and a module.

use crate::discovery::{Found, serial_ports, usb_chips};
use crate::mock_board::open_mock;
use crate::open::{check_simulated, open_simulated};
use crate::replay::{check_replay, open_replay};
use crate::{BoardKind, Link, OpenError, SerialLink, Target, TcpLink, UsbLink};

/// A way to write a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Form {
    /// The target; words in capitals are to be filled in.
    pub target: &'static str,
    /// What it leads to, for people.
    pub summary: &'static str,
}

/// Where a board is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In this program, or in a file.
    Program,
    /// Behind a USB chip that is plugged into this computer.
    Chip,
    /// Behind a serial port of this computer.
    Port,
    /// Behind a port of a computer, this one or another, as `HOST:PORT`.
    Host,
}

/// A kind of board.
#[derive(Debug)]
pub struct Kind {
    /// The word that a target begins with.
    pub name: &'static str,
    /// Every way to write one, the usual one first.
    pub forms: &'static [Form],
    /// What is at the other end, as far as the kind tells.
    pub board: BoardKind,
    /// Where it is.
    pub place: Place,
    /// Checks that a target's address and options suit the kind, without opening anything.
    pub(crate) check: fn(&Target) -> Result<(), OpenError>,
    /// Opens the link without sending anything over it.
    pub(crate) open: fn(&Target) -> Result<Box<dyn Link>, OpenError>,
    /// The option that names a file that such a board writes, if there is one.
    pub(crate) writes: Option<&'static str>,
    /// Lists what could be such a board on this computer. What cannot be listed at all is left out.
    pub find: fn() -> Vec<Found>,
}

/// The option of a simulated board that names the file of its waveform.
pub(crate) const TRACE: &str = "trace";

/// All of them, the built-in ones first.
pub static KINDS: [Kind; 6] = [
    Kind {
        name: "mock",
        forms: &[Form {
            target: "mock",
            summary: "a board in this program; mock,KEY=VALUE sets its build, its wire and its fault",
        }],
        board: BoardKind::Mock,
        place: Place::Program,
        check: |target| open_mock(target).map(drop),
        open: open_mock,
        writes: None,
        find: Vec::new,
    },
    Kind {
        name: "sim",
        forms: &[
            Form {
                target: "sim",
                summary: "the board's Verilog under simulation; sim,KEY=VALUE sets its wire and that wire's fault, \
                          trace=FILE writes a waveform (in programs built with Cargo's feature `sim`)",
            },
            Form { target: "sim:uart", summary: "the same behind the pins of its UART" },
            Form { target: "sim:fifo", summary: "the same behind the pins of its FT2232H" },
        ],
        board: BoardKind::Sim,
        place: Place::Program,
        check: check_simulated,
        open: open_simulated,
        writes: Some(TRACE),
        find: Vec::new,
    },
    Kind {
        name: "usb",
        forms: &[
            Form {
                target: "usb",
                summary: "the one board behind an FT2232H or FT232H, without the serial driver",
            },
            Form { target: "usb:SERIAL", summary: "the one with this serial number, when there are several" },
        ],
        board: BoardKind::Hardware,
        place: Place::Chip,
        check: UsbLink::check,
        open: |target| Ok(Box::new(UsbLink::open(target)?)),
        writes: None,
        find: usb_chips::find,
    },
    Kind {
        name: "serial",
        forms: &[Form {
            target: "serial:PATH",
            summary: "the board behind a serial port; board=NAME sets the port as that board needs it",
        }],
        board: BoardKind::Hardware,
        place: Place::Port,
        check: SerialLink::check,
        open: |target| Ok(Box::new(SerialLink::open(target)?)),
        writes: None,
        find: serial_ports::find,
    },
    Kind {
        name: "tcp",
        forms: &[Form {
            target: "tcp:HOST:PORT",
            summary: "the board that another computer exports as raw bytes",
        }],
        board: BoardKind::Hardware,
        place: Place::Host,
        check: TcpLink::check,
        open: |target| Ok(Box::new(TcpLink::open(target)?)),
        writes: None,
        find: Vec::new,
    },
    Kind {
        name: "replay",
        forms: &[Form { target: "replay:FILE", summary: "the board that answered when FILE was recorded" }],
        board: BoardKind::Replay,
        place: Place::Program,
        check: check_replay,
        open: open_replay,
        writes: None,
        find: Vec::new,
    },
];

impl Kind {
    /// Every way to write one.
    #[must_use]
    pub fn targets(&self) -> Vec<&'static str> {
        self.forms.iter().map(|form| form.target).collect()
    }
}

/// The kind of `target`, if it exists.
#[must_use]
pub fn of(target: &Target) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == target.kind)
}

/// What is at the other end of `target`, as far as its kind tells; hardware for a kind that is not known here.
#[must_use]
pub fn board_of(target: &Target) -> BoardKind {
    of(target).map_or(BoardKind::Hardware, |kind| kind.board)
}

/// Where the board of `target` is, if its kind is known here.
#[must_use]
pub fn place_of(target: &Target) -> Option<Place> {
    of(target).map(|kind| kind.place)
}

/// Every way to write a target of any kind.
#[must_use]
pub fn forms() -> Vec<&'static str> {
    KINDS.iter().flat_map(Kind::targets).collect()
}
