//! Everything on this computer that could be a board. Nothing is touched unless that is asked for.

mod answer;
pub(crate) mod serial_ports;
pub(crate) mod usb_chips;

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::access::Kept;
use crate::ftdi::{self, Speed};
use crate::kinds::{self, KINDS, Place, place_of};
use crate::{BoardKind, Holder, SerialBoard, Target, UsbDevice};

pub use answer::Answer;

/// Everything on this computer that could be a board, in the order of [`KINDS`].
#[must_use]
pub fn find() -> Vec<Found> {
    KINDS.iter().flat_map(|kind| (kind.find)()).collect()
}

/// How often to look whether a port is back.
const LOOK: Duration = Duration::from_millis(10);

/// Waits until every serial port of `found` that could be opened can be opened again, at most for `limit`. Whoever lets go of a USB
/// chip gets its serial ports back at once, but under another owner and without their stable names until udev has seen them.
pub fn await_ports(found: &[Found], limit: Duration) {
    let ports: Vec<_> =
        found.iter().filter(|device| device.is_open_to_us()).filter_map(Found::port).collect();
    let begun = Instant::now();
    while ports.iter().any(|port| Kept::is(port).is_some()) && begun.elapsed() < limit {
        thread::sleep(LOOK);
    }
}

/// Something that could be a board.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    /// The target that leads to it, with the most stable name that it has.
    pub target: String,
    /// The kind of board that such a target promises.
    pub kind: BoardKind,
    /// What it is, for people.
    pub summary: String,
    /// Its device file, as the kernel names it now.
    pub device: Option<PathBuf>,
    /// Further names, which stay the same: by serial number, or by the socket that it is plugged into.
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
    /// Yes, as far as can be told without opening it.
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
    /// This cannot be told without connecting.
    Unknown,
}

impl Found {
    /// What `target` leads to, even if it is not among what is found.
    #[must_use]
    pub fn named(target: &Target) -> Self {
        match (&target.address, target.kind.as_str()) {
            (Some(path), "serial") => {
                Self { target: target.to_string(), ..serial_ports::look_at(&PathBuf::from(path)) }
            }
            _ => Self {
                target: target.to_string(),
                kind: kinds::board_of(target),
                summary: "named in the call".to_owned(),
                device: None,
                names: Vec::new(),
                usb: None,
                access: Access::Unknown,
                answer: None,
            },
        }
    }

    /// A second target to ask if no board answers at [`Self::target`]: behind a chip that cannot make the usual rate of a serial
    /// port, the board that runs at the fastest rate that it makes.
    #[must_use]
    pub fn further_target(&self) -> Option<String> {
        let chip = self.usb.as_ref().filter(|usb| usb.vendor_id == ftdi::VENDOR)?;
        let speed = Speed::of(chip.device_version);
        let is_plain = self.target.starts_with("serial:") && !self.target.contains(',');
        let board = SerialBoard::behind(speed).filter(|_| is_plain && speed == Speed::Full)?;
        Some(format!("{},board={}", self.target, board.name))
    }

    /// The serial port to which its target leads, if it leads to one.
    fn port(&self) -> Option<PathBuf> {
        let target: Target = self.target.parse().ok()?;
        let is_port = place_of(&target) == Some(Place::Port);
        target.address.filter(|_| is_port).map(PathBuf::from)
    }

    /// Whether asking it takes away, for as long, the serial ports that the system's driver made of its chip.
    #[must_use]
    pub fn takes_ports(&self) -> bool {
        self.target.parse().is_ok_and(|target| place_of(&target) == Some(Place::Chip))
    }

    /// Whether it is worth asking.
    #[must_use]
    pub fn is_open_to_us(&self) -> bool {
        matches!(self.access, Access::Free | Access::Unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A serial port with a chip of FTDI's.
    fn behind(device_version: u16, target: &str) -> Found {
        let usb = UsbDevice {
            vendor_id: ftdi::VENDOR,
            product_id: 0x6015,
            device_version,
            manufacturer: None,
            product: None,
            serial: None,
            interface: None,
        };
        Found { usb: Some(usb), ..Found::named(&target.parse().unwrap()) }
    }

    #[test]
    fn only_a_usb_chip_takes_ports() {
        for (target, takes) in [
            ("usb", true),
            ("usb:FT3XYZ", true),
            ("usb,flow=none", true),
            ("serial:/dev/ttyUSB0,board=ulx3s", false),
            ("serial:usb", false),
            ("tcp:usb:3001", false),
        ] {
            assert_eq!(Found::named(&target.parse().unwrap()).takes_ports(), takes, "{target}");
        }
    }

    /// As udev names and gives away a port, which here takes until the other thread runs.
    #[test]
    fn ports_that_could_be_opened_are_awaited_and_no_others() {
        const LONG: Duration = Duration::from_secs(600);
        let folder = tempfile::tempdir().unwrap();
        let port = |name: &str, access| {
            let target = format!("serial:{},board=ulx3s", folder.path().join(name).display());
            Found { access, ..Found::named(&target.parse().unwrap()) }
        };
        let ports = [port("ours", Access::Free), port("other", Access::Missing)];
        let ours = folder.path().join("ours");
        thread::scope(|scope| {
            scope.spawn(|| std::fs::write(&ours, "").unwrap());
            await_ports(&ports, LONG);
            assert!(ours.exists());
        });
        // One that stays away is not waited for any longer.
        await_ports(&[port("gone", Access::Free)], Duration::ZERO);
    }

    #[test]
    fn a_port_whose_chip_makes_3_mbaud_at_most_is_also_asked_as_a_ulx3s_is() {
        let (ft231x, ft2232h) = (0x1000, 0x0700);
        let asked = |version, target| behind(version, target).further_target();
        let port = "serial:/dev/ttyUSB99";
        assert_eq!(asked(ft231x, port).unwrap(), "serial:/dev/ttyUSB99,board=ulx3s");
        assert_eq!(asked(ft2232h, port), None);
        // A target that names its own options is asked only as it says.
        assert_eq!(asked(ft231x, "serial:/dev/ttyUSB99,baud=115200"), None);
        assert_eq!(Found::named(&port.parse().unwrap()).further_target(), None);
    }
}
