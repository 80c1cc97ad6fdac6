//! Everything on this computer that could be a board, without touching any of it unless asked.

mod answer;
mod serial_ports;
mod usb_chips;

use std::path::PathBuf;

use serde::Serialize;

use crate::target::{BoardKind, Target};
use crate::{Holder, UsbDevice};

pub use answer::Answer;
use serial_ports::SerialPorts;
use usb_chips::UsbChips;

/// A place where boards are found: the serial ports, or another kind of device.
pub trait Source {
    /// What is there. What cannot be listed at all is not there.
    fn find(&self) -> Vec<Found>;
}

/// Every source there is, in the order in which they are listed.
#[must_use]
pub fn sources() -> Vec<Box<dyn Source>> {
    vec![Box::new(UsbChips), Box::new(SerialPorts)]
}

/// Something that could be a board.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    /// The target that leads to it, by the most stable name that it has.
    pub target: String,
    /// What a target of this kind is.
    pub kind: BoardKind,
    /// What it is, for people.
    pub summary: String,
    /// Its device file as the kernel names it now.
    pub device: Option<PathBuf>,
    /// Further names, which stay: by serial number, by the socket that it is plugged into.
    pub names: Vec<PathBuf>,
    /// The USB device that it belongs to.
    pub usb: Option<UsbDevice>,
    /// Whether it can be opened.
    pub access: Access,
    /// What it answered; none if it was not asked.
    pub answer: Option<Answer>,
}

/// Whether a device can be opened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub enum Access {
    /// As far as it can be told without opening it.
    Free,
    /// Others have it open.
    Busy {
        /// Who, as far as this user may know.
        holders: Vec<Holder>,
    },
    /// This user may not open it.
    Denied {
        /// How to get access.
        remedy: String,
    },
    /// It is not there.
    Missing,
    /// It cannot be told without connecting.
    Unknown,
}

impl Found {
    /// What `target` leads to, which need not be among what the sources find.
    #[must_use]
    pub fn named(target: &Target) -> Self {
        match (&target.address, target.kind.as_str()) {
            (Some(path), "serial") => {
                Self { target: target.to_string(), ..serial_ports::look_at(&PathBuf::from(path)) }
            }
            (_, kind) => Self {
                target: target.to_string(),
                kind: match kind {
                    "mock" => BoardKind::Mock,
                    "sim" => BoardKind::Sim,
                    "replay" => BoardKind::Replay,
                    _ => BoardKind::Hardware,
                },
                summary: "named in the call".to_owned(),
                device: None,
                names: Vec::new(),
                usb: None,
                access: Access::Unknown,
                answer: None,
            },
        }
    }

    /// Whether it makes sense to ask it.
    #[must_use]
    pub fn is_open_to_us(&self) -> bool {
        matches!(self.access, Access::Free | Access::Unknown)
    }
}
