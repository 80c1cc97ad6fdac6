//! Why a board cannot be opened over USB.

use super::find::UsbBoard;
use super::transport::UsbFailure;
use crate::Class;
use crate::access::HAVE_IT;
use crate::ftdi::list;
use crate::serial::{Holder, by};

/// Why a board cannot be opened over USB.
#[derive(Debug, thiserror::Error)]
pub enum UsbError {
    /// No USB is available on this computer, for this reason of libusb's.
    #[error(
        "no USB is available on this computer; use a computer that has it, or see `halfrow boards` for other links"
    )]
    NoUsb(#[source] UsbFailure),
    /// No board with an FTDI chip is plugged in.
    #[error(
        "no board with an FTDI chip is plugged in; check cable and power, and, in a virtual machine or container, \
         that it is given the device"
    )]
    NoneFound,
    /// Only FTDI chips of full speed are plugged in, none of which is chosen unless the target names it.
    #[error(
        "no FT2232H, FT4232H or FT232H is plugged in; if the board is behind another chip, choose that: {}", targets(.0)
    )]
    OthersOnly(Vec<UsbBoard>),
    /// No FTDI chip of this name is plugged in.
    #[error("no FTDI chip is called `{wanted}`; {}", there_are(.found))]
    NotFound {
        /// What the target says.
        wanted: String,
        /// What is there.
        found: Vec<UsbBoard>,
    },
    /// Several boards are plugged in, and the target does not say which one.
    #[error("several boards could be meant; choose one: {}", targets(.0))]
    Several(Vec<UsbBoard>),
    /// The chip does not have this channel.
    #[error(
        "the {chip} {name} has no channel {channel}; leave `channel=` out, or choose one of its {channels}"
    )]
    NoChannel {
        /// The chip.
        chip: &'static str,
        /// Its name.
        name: String,
        /// The letter.
        channel: char,
        /// How many it has.
        channels: u8,
    },
    /// This user may not open the USB device.
    #[error("this user may not open the USB device {name}; {remedy}")]
    NotPermitted {
        /// The chip's name.
        name: String,
        /// How to get access.
        remedy: String,
    },
    /// The USB device is plugged in, but this program is not given it, as in a container to which it was not passed on.
    #[error("the USB device {name} is plugged in, but this program is not given it; {}", HAVE_IT)]
    NotGiven {
        /// The chip's name.
        name: String,
    },
    /// Another program is using the USB device.
    #[error("{} is in use by {}", .what, by(.holders))]
    Busy {
        /// The channel, or its serial port.
        what: String,
        /// By whom, as far as this user may know.
        holders: Vec<Holder>,
    },
    /// The chip's channel is set up for another mode than the target asks for.
    #[error(
        "channel {channel} of {name} is {found}, and the target asks for mode={wanted}. {}", advice(.wanted)
    )]
    OtherMode {
        /// The chip's name.
        name: String,
        /// The channel.
        channel: char,
        /// What its EEPROM says.
        found: String,
        /// `fifo` or `uart`.
        wanted: &'static str,
    },
    /// The chip's channel is set up for a mode that is neither a UART nor a FIFO, and that this program cannot use.
    #[error(
        "channel {channel} of {name} is {found}, which this program cannot use; choose the channel of the board's FPGA, or set this one to \
         `245 FIFO` or `RS232 UART`, as the bitstream has it, with FT_PROG or ftdi_eeprom (save the old contents first), then \
         unplug the board and plug it in"
    )]
    UnusableMode {
        /// The chip's name.
        name: String,
        /// The channel.
        channel: char,
        /// What its EEPROM says.
        found: String,
    },
    /// The target asks for a FIFO, and a chip of this kind has none.
    #[error("the {chip} {name} has no FIFO; leave `mode=fifo` out, and load a bitstream with a UART")]
    NoFifo {
        /// The chip.
        chip: &'static str,
        /// Its name.
        name: String,
    },
    /// What the chip's channel is set up for cannot be told.
    #[error(
        "channel {channel} of {name} is {found}; choose another channel, or say mode=fifo or mode=uart if you know it"
    )]
    NoMode {
        /// The chip's name.
        name: String,
        /// The channel.
        channel: char,
        /// What is known.
        found: String,
    },
    /// The target gives a baud rate, but the chip's channel is set up as a FIFO, which has none.
    #[error("this channel is a FIFO, which has no baud rate; leave out `baud=`")]
    BaudOfFifo,
    /// The USB chip cannot make this baud rate.
    #[error("an {chip} cannot make {baud} baud; the nearest rates that it makes: {}", list(.nearest))]
    Rate {
        /// The chip.
        chip: &'static str,
        /// What was asked for.
        baud: u32,
        /// What it can make.
        nearest: Vec<u32>,
    },
    /// The system gives this program no thread that moves bytes over USB.
    #[error(
        "this computer has no thread left to serve {name}; end other programs, or allow this user more processes, then run again"
    )]
    NoThread {
        /// The chip's name.
        name: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A transfer over USB failed.
    #[error("{name} failed while {doing}; unplug the board, plug it in, and run again")]
    Transfer {
        /// The chip's name.
        name: String,
        /// What was under way.
        doing: &'static str,
        /// How.
        #[source]
        source: UsbFailure,
    },
}

impl UsbError {
    /// Who can do something about it.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::NoChannel { .. } | Self::NoFifo { .. } => Class::Call,
            Self::BaudOfFifo | Self::Rate { .. } => Class::Call,
            Self::Several(_) | Self::OthersOnly(_) => Class::Call,
            Self::Busy { .. } => Class::Busy,
            _ => Class::Station,
        }
    }
}

fn there_are(found: &[UsbBoard]) -> String {
    if found.is_empty() { "none is plugged in".to_owned() } else { format!("there are {}", targets(found)) }
}

fn targets(found: &[UsbBoard]) -> String {
    let lines: Vec<String> = found.iter().map(|board| format!("{} ({board})", board.target(found))).collect();
    lines.join(", ")
}

fn advice(wanted: &str) -> &'static str {
    match wanted {
        "fifo" => {
            "A bitstream with a FIFO would read noise from these pins. Load one with a UART and say mode=uart, or set the channel \
             to `245 FIFO` with FT_PROG or ftdi_eeprom (save the old contents first), then unplug the board and plug it in"
        }
        _ => {
            "A bitstream with a UART would hear nothing. Load one with a FIFO and say mode=fifo, or set the channel to \
             `RS232 UART` with FT_PROG or ftdi_eeprom (save the old contents first), then unplug the board and plug it in"
        }
    }
}
