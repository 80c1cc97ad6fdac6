//! Serial ports that cannot be opened, each with what to do.

use std::path::{Path, PathBuf};

use super::Holder;
use super::holder::by;
use crate::Class;
use crate::access::HAVE_IT;
use crate::ftdi::list;

/// A serial port that cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum SerialError {
    /// There is no serial port of this name.
    #[error(
        "there is no serial port {}; {}check that the board is plugged in and powered, and see `halfrow boards` for \
         those that are there, or unplug the board and plug it in if a program that used its USB chip was killed",
        .0.display(),
        below_dev(.0)
    )]
    Missing(PathBuf),
    /// The file of this name is not a serial port.
    #[error("{0} is no serial port; see `halfrow boards` for those that are there")]
    NotAPort(PathBuf),
    /// This user may not open the serial port.
    #[error("you may not open {path}; {remedy}")]
    NotAllowed {
        /// The port.
        path: PathBuf,
        /// How to get access.
        remedy: String,
    },
    /// The serial port is there, but this program is not given it, as in a container to which it was not passed on.
    #[error("{} is on this computer, but this program is not given it; {}", .0.display(), HAVE_IT)]
    NotGiven(PathBuf),
    /// Another program is using the serial port.
    #[error("{path} is in use by {}", by(.holders))]
    InUse {
        /// The port.
        path: PathBuf,
        /// By whom, as far as it can be told.
        holders: Vec<Holder>,
    },
    /// The chip behind the serial port cannot make this baud rate.
    #[error(
        "{chip}, which is behind {path}, cannot make {baud} baud; the nearest that it makes: {}",
        list(.nearest)
    )]
    Rate {
        /// The port.
        path: PathBuf,
        /// Which chip.
        chip: &'static str,
        /// What was asked for.
        baud: u32,
        /// What it can do.
        nearest: Vec<u32>,
    },
    /// The serial port's driver set another baud rate than was asked for.
    #[error(
        "{path} does not support {baud} baud (its driver set {taken}); add baud=RATE with a rate that port and board \
         support"
    )]
    OtherRate {
        /// The port.
        path: PathBuf,
        /// What was asked for.
        baud: u32,
        /// What it took.
        taken: u32,
    },
    /// The serial port cannot be opened, for a reason that the system's own message tells.
    #[error("{path} cannot be opened; unplug the board, plug it in and run again")]
    Other {
        /// The port.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
}

impl SerialError {
    /// Who can do something about it.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::InUse { .. } => Class::Busy,
            Self::NotAPort(_) | Self::Rate { .. } | Self::OtherRate { .. } => Class::Call,
            _ => Class::Station,
        }
    }
}

/// The remedy for a port that was named without its folder, as other programs allow.
fn below_dev(port: &Path) -> String {
    let device = Path::new("/dev").join(port);
    let is_meant = port.is_relative() && device.exists();
    if is_meant { format!("write serial:{}, or ", device.display()) } else { String::new() }
}
