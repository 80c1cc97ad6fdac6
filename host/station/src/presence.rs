//! Whether there is a board in a lane, as far as can be seen without touching it, even through libusb.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use halfrow::link::kinds::{self, Place};
use halfrow::target::Target;

/// Where Linux lists USB devices.
pub(crate) const USB: &str = "/sys/bus/usb/devices";
/// Where Linux lists serial ports.
pub(crate) const PORTS: &str = "/sys/class/tty";
/// FTDI's USB vendor id.
const FTDI: &str = "0403";
/// How long a board must be away before it counts as gone.
const GONE: Duration = Duration::from_secs(1);

/// An FTDI chip that is plugged in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chip {
    /// Where, such as `1-2.3`.
    pub(crate) place: String,
    /// Its serial number.
    serial: Option<String>,
}

/// The chips that the folder `devices` lists, sorted by place.
pub(crate) fn chips(devices: &Path) -> Vec<Chip> {
    let chip = |entry: fs::DirEntry| {
        let read = |name| fs::read_to_string(entry.path().join(name)).ok().map(|text| text.trim().to_owned());
        let is_ftdi = read("idVendor").as_deref() == Some(FTDI);
        is_ftdi
            .then(|| Chip { place: entry.file_name().to_string_lossy().into_owned(), serial: read("serial") })
    };
    let entries = fs::read_dir(devices).into_iter().flatten().filter_map(Result::ok);
    let mut chips: Vec<_> = entries.filter_map(chip).collect();
    chips.sort_by(|one, other| one.place.cmp(&other.place));
    chips
}

/// What is plugged in where a board is.
enum Plug<'a> {
    /// A serial port at this path.
    Port(&'a str),
    /// A USB chip with this name.
    Chip(&'a str),
}

/// What is plugged in for `board`; none if nothing is, as for `tcp:` or `mock`.
fn plug(board: &Target) -> Option<Plug<'_>> {
    let address = board.address.as_deref()?;
    match kinds::place_of(board)? {
        Place::Port => Some(Plug::Port(address)),
        Place::Chip => Some(Plug::Chip(address)),
        Place::Host | Place::Program => None,
    }
}

/// Whether something is plugged in at `board`. A board that is not plugged in anywhere always counts as present.
#[must_use]
pub(crate) fn is_there(board: &Target, devices: &Path) -> bool {
    plug(board).is_none_or(|plug| match plug {
        Plug::Port(path) => Path::new(path).exists(),
        Plug::Chip(name) => {
            chips(devices).iter().any(|chip| chip.place == name || chip.serial.as_deref() == Some(name))
        }
    })
}

/// Whether `board` is plugged in and out, so that it may be absent.
#[must_use]
pub(crate) fn is_pluggable(board: &Target) -> bool {
    plug(board).is_some()
}

/// Whether both names are of one board, as far as they and what is plugged in say. A chip that `usb:` names has one board,
/// unless the name says at which channel, and `ports` says which serial ports are of that chip, too. Two ports of a chip may
/// have a board each.
pub(crate) fn is_same(one: &Target, other: &Target, devices: &Path, ports: &Path) -> bool {
    match (kinds::place_of(one), kinds::place_of(other)) {
        (Some(Place::Chip), Some(Place::Port)) => {
            interface_of(other, ports).is_some_and(|(chip, interface)| {
                Some(chip) == place(one, devices) && channel(one).is_none_or(|channel| channel == interface)
            })
        }
        (Some(Place::Port), Some(Place::Chip)) => is_same(other, one, devices, ports),
        _ => {
            one.kind == other.kind
                && place(one, devices).is_some_and(|one| Some(one) == place(other, devices))
        }
    }
}

/// The place of a board that has one. Several names of a device that is plugged in lead to the same place.
fn place(board: &Target, devices: &Path) -> Option<PathBuf> {
    let address = board.address.as_deref()?;
    let found = match kinds::place_of(board) {
        Some(Place::Port) => fs::canonicalize(address).ok(),
        Some(Place::Chip) => {
            let chip = chips(devices).into_iter().find(|chip| chip.serial.as_deref() == Some(address));
            chip.map(|chip| chip.place.into())
        }
        // Hosts are the same in either case (RFC 4343).
        Some(Place::Host) => Some(address.to_ascii_lowercase().into()),
        Some(Place::Program) | None => None,
    };
    Some(found.unwrap_or_else(|| address.into()))
}

/// The channel of a chip that a `usb:` name says its board is at: its interface's number there, from 0.
fn channel(board: &Target) -> Option<u32> {
    let letter = board.option("channel")?;
    let place = ["a", "b", "c", "d"].iter().position(|known| *known == letter)?;
    u32::try_from(place).ok()
}

/// The place of the USB device that a serial port is of, if it is plugged in and of one, and the number of its interface there.
fn interface_of(port: &Target, ports: &Path) -> Option<(PathBuf, u32)> {
    let port = fs::canonicalize(port.address.as_deref()?).ok()?;
    let port = fs::canonicalize(ports.join(port.file_name()?).join("device")).ok()?;
    let interface = port
        .ancestors()
        .find(|folder| folder.parent().is_some_and(|device| device.join("idVendor").is_file()))?;
    let (_, number) = interface.file_name()?.to_str()?.rsplit_once('.')?;
    Some((interface.parent()?.file_name()?.into(), number.parse().ok()?))
}

/// Whether a board is present. Short absences while its system starts are ignored.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Presence {
    is_there: bool,
    away_since: Option<Duration>,
}

impl Presence {
    /// Takes note of whether the board is seen at the time `now`. Returns whether it is now present, if that has changed.
    pub(crate) fn look(&mut self, is_seen: bool, now: Duration) -> Option<bool> {
        let away_since = if is_seen { None } else { Some(self.away_since.unwrap_or(now)) };
        self.away_since = away_since;
        let is_there = match away_since {
            None => true,
            Some(since) => self.is_there && now.saturating_sub(since) < GONE,
        };
        let changed = (is_there != self.is_there).then_some(is_there);
        self.is_there = is_there;
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_gone_when_it_was_away_for_a_second() {
        let mut presence = Presence::default();
        let looks = [
            (0, false, None),
            (500, true, Some(true)),
            (1000, false, None),
            (1500, true, None),
            (2000, false, None),
            (2999, false, None),
            (3000, false, Some(false)),
            (3500, false, None),
            (4000, true, Some(true)),
        ];
        for (at, is_seen, change) in looks {
            assert_eq!(presence.look(is_seen, Duration::from_millis(at)), change, "at {at} ms");
        }
    }

    #[test]
    fn a_chip_is_seen_by_its_place_and_by_its_number() {
        let devices = tempfile::tempdir().unwrap();
        for (place, vendor, serial) in
            [("1-2.3", "0403", Some("FT3XYZ")), ("1-1", "046d", Some("MOUSE")), ("2-1", "0403", None)]
        {
            let folder = devices.path().join(place);
            fs::create_dir(&folder).unwrap();
            fs::write(folder.join("idVendor"), format!("{vendor}\n")).unwrap();
            if let Some(serial) = serial {
                fs::write(folder.join("serial"), format!("{serial}\n")).unwrap();
            }
        }
        let seen = |target: &str| is_there(&target.parse().unwrap(), devices.path());
        assert!(seen("usb:1-2.3") && seen("usb:FT3XYZ") && seen("usb:2-1"));
        assert!(!seen("usb:1-1") && !seen("usb:MOUSE") && !seen("usb:1-2"));
        let is_same = |one: &str, other: &str| {
            let [one, other] = [one, other].map(|name| name.parse().unwrap());
            is_same(&one, &other, devices.path(), devices.path())
        };
        assert!(is_same("usb:1-2.3", "usb:FT3XYZ") && is_same("tcp:bench:1", "tcp:bench:1,baud=9600"));
        assert!(
            is_same("tcp:Bench:1", "tcp:bench:1,baud=9600"),
            "no host differs from another in its case alone"
        );
        assert!(!is_same("usb:1-2.3", "usb:2-1") && !is_same("tcp:bench:1", "tcp:bench:2"));
        let port = devices.path().join("port");
        let target = format!("serial:{}", port.display());
        assert!(!seen(&target));
        fs::write(&port, "").unwrap();
        assert!(seen(&target) && seen("mock") && seen("tcp:bench:3001"));
    }

    /// As Linux lists an FT2232H: the device, its two interfaces, and the port of each.
    #[test]
    fn a_chip_is_the_same_by_usb_and_by_its_serial_ports() {
        let folder = tempfile::tempdir().unwrap();
        let [devices, ports, files] = ["devices", "ports", "dev"].map(|name| folder.path().join(name));
        for (number, place) in [("0", "1-2.3"), ("1", "1-2.3"), ("2", "1-4")] {
            let device = devices.join(place);
            let name = format!("ttyUSB{number}");
            let interface = device.join(format!("{place}:1.{number}")).join(&name);
            for folder in [&interface, &ports.join(&name), &files] {
                fs::create_dir_all(folder).unwrap();
            }
            fs::write(device.join("idVendor"), "0403\n").unwrap();
            fs::write(device.join("serial"), format!("FT{place}\n")).unwrap();
            std::os::unix::fs::symlink(interface, ports.join(&name).join("device")).unwrap();
            fs::write(files.join(name), "").unwrap();
        }
        std::os::unix::fs::symlink(files.join("ttyUSB1"), files.join("by-path")).unwrap();
        let port = |name: &str| format!("serial:{}", files.join(name).display());
        let same = |one: &str, other: &str| {
            let [one, other] = [one, other].map(|name| name.parse().unwrap());
            is_same(&one, &other, &devices, &ports)
        };
        let of_channel =
            ["ttyUSB0", "ttyUSB1", "ttyUSB2"].map(|name| same("usb:1-2.3,channel=b", &port(name)));
        assert_eq!(of_channel, [false, true, false]);
        for usb in ["usb:1-2.3", "usb:FT1-2.3"] {
            let of_ports = ["ttyUSB0", "by-path", "ttyUSB2", "none"].map(|name| same(usb, &port(name)));
            assert_eq!(of_ports, [true, true, false, false], "{usb}");
            assert!(same(&port("by-path"), usb));
        }
        assert!(same(&port("by-path"), &port("ttyUSB1")));
        assert!(!same(&port("ttyUSB0"), &port("ttyUSB1")), "each may have a board");
    }
}
