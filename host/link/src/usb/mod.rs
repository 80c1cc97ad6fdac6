//! Boards with one of FTDI's USB chips, without the system's serial driver.
//!
//! ```text
//! UsbLink ─ Threads: one reads, one writes ─► Transport: libusb ─► chip ─ FIFO or UART ─► board
//! ```
//!
//! The driver makes serial ports of both channels, moves 512 bytes at a time, and knows no FIFO. Here only one interface is
//! claimed, the other one stays with whoever has it, and a read is always under way.

mod chip;
mod eeprom;
mod error;
mod find;
mod ftdi;
mod options;
mod packets;
mod threads;
mod transport;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use chip::{Channel, Chip, FULL_SPEED_PACKET};
use find::{FtdiDevice, choose, folder_of, interface};
use ftdi::{Ftdi, Ready};
use options::UsbOptions;
use packets::strip;
use threads::Threads;
use transport::{Libusb, Transport};

use super::serial::{Holder, keepers};
use super::{HEED, Link, LinkError, bytes_per_second};
use crate::access::{Kept, how_to_get_access};
use crate::target::Target;
use crate::{LineErrors, OpenError};

pub use error::UsbError;
pub use find::UsbBoard;
pub(crate) use find::usb_boards;
pub use transport::UsbFailure;

/// What an FPGA with two synchronisers gets through an asynchronous FIFO: about 5 MB/s. The data sheet says 8.
const FIFO_BYTES_PER_SECOND: f64 = 5e6;

/// What FTDI's data sheets say of their chips of full speed (FT245BM, "Features"), which is near all that USB lets through there.
const FULL_SPEED_BYTES_PER_SECOND: f64 = 1e6;

/// A pipe through a channel of a chip.
pub(crate) struct UsbLink {
    threads: Threads,
    name: String,
    bytes_per_second: f64,
    waits_for_cts: bool,
    opened: Instant,
}

impl UsbLink {
    /// Checks that `target` has options of this kind.
    pub(crate) fn check(target: &Target) -> Result<(), OpenError> {
        asked(target).map(drop)
    }

    /// Opens the channel that `target` names and makes it ready, without sending anything over it.
    ///
    /// # Errors
    /// [`OpenError`] when the target is no such target, or its chip cannot be opened.
    pub(crate) fn open(target: &Target) -> Result<Self, OpenError> {
        let options = asked(target)?;
        let (found, name) = choose(target.address.as_deref())?;
        let chip = found.chip;
        let channel = options.channel.map_or(chip.usual_channel(), Channel);
        if channel.0 >= chip.channels() {
            let (channel, channels) = (channel.letter(), chip.channels());
            return Err(UsbError::NoChannel { chip: chip.name(), name, channel, channels }.into());
        }
        Ok(Self::over(claim(&found, channel, &name)?, chip, channel, &name, &options)?)
    }

    /// Makes the channel of the `chip` behind `transport` ready, which is called `name` in errors.
    fn over(
        transport: impl Transport + 'static,
        chip: Chip,
        channel: Channel,
        name: &str,
        options: &UsbOptions,
    ) -> Result<Self, UsbError> {
        let ready = Ftdi { transport: &transport, chip, channel, name }.make_ready(options)?;
        let (what, bytes_per_second) = match ready {
            Ready::Fifo => ("FIFO".to_owned(), FIFO_BYTES_PER_SECOND),
            Ready::Uart { baud, .. } => (format!("{baud} baud"), bytes_per_second(baud)),
        };
        let packet = transport.packet().unwrap_or(chip.packet());
        let most = if packet <= FULL_SPEED_PACKET { FULL_SPEED_BYTES_PER_SECOND } else { f64::INFINITY };
        let is_line = ready != Ready::Fifo;
        let unpack = Box::new(move |transfer: &[u8], data: &mut Vec<u8>, errors: &mut LineErrors| {
            strip(transfer, packet, data, is_line, errors);
        });
        let threads = Threads::start(Box::new(transport), unpack);
        let threads = threads.map_err(|source| UsbError::NoThread { name: name.to_owned(), source })?;
        Ok(Self {
            threads,
            name: format!("{name} ({}, channel {}, {what})", chip.name(), channel.letter()),
            bytes_per_second: bytes_per_second.min(most),
            waits_for_cts: matches!(ready, Ready::Uart { handshake: true, .. }),
            opened: Instant::now(),
        })
    }
}

/// Claims the channel's interface, unless another program has opened it or its serial port.
fn claim(found: &FtdiDevice, channel: Channel, name: &str) -> Result<Libusb, UsbError> {
    for port in serial_ports(&found.board.place, channel) {
        if let Some(holders) = held(&port) {
            return Err(UsbError::Busy { what: port.display().to_string(), holders });
        }
    }
    let failed = |error| failed(error, &found.board, channel, name);
    let handle = found.device.open().map_err(|error| {
        // A device that is unplugged leaves its folder with it.
        let is_there = || folder_of(&found.board.place).exists();
        match Kept::is(&found.board.file) {
            Some(Kept::FromProgram) if is_there() => UsbError::NotGiven { name: name.to_owned() },
            _ => failed(error),
        }
    })?;
    Libusb::claim(handle, channel.0, found.chip.endpoints(channel)).map_err(failed)
}

/// What libusb's `error` says of a channel of `board` that cannot be claimed.
fn failed(error: rusb::Error, board: &UsbBoard, channel: Channel, name: &str) -> UsbError {
    match error {
        rusb::Error::Access => {
            let remedy = how_to_get_access(&board.file, Some(&board.device));
            UsbError::NotPermitted { name: name.to_owned(), remedy }
        }
        rusb::Error::Busy => UsbError::Busy {
            what: format!("channel {} of {name}", channel.letter()),
            holders: keepers(&board.file),
        },
        other => {
            let source = transport::failure(other);
            UsbError::Transfer { name: name.to_owned(), doing: "opening the device", source }
        }
    }
}

/// The options of a target. Its address, if it has one, is a name; an empty one was forgotten.
fn asked(target: &Target) -> Result<UsbOptions, OpenError> {
    if target.address.as_deref() == Some("") {
        return Err(OpenError::address_missing(target));
    }
    UsbOptions::of(target)
}

/// The serial ports that the system's driver made of the channel.
fn serial_ports(place: &str, channel: Channel) -> Vec<PathBuf> {
    let entries = fs::read_dir(interface(place, channel)).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|name| name.starts_with("ttyUSB")).map(|name| Path::new("/dev").join(name)).collect()
}

/// Who has a serial port open, if anybody has. The list may be empty even then. The driver would give the port up even while
/// somebody reads it.
fn held(port: &Path) -> Option<Vec<Holder>> {
    let holders = keepers(port);
    (!holders.is_empty() || is_locked(port)).then_some(holders)
}

/// Whether the program of another user, which cannot be seen, has locked the port.
fn is_locked(port: &Path) -> bool {
    use std::io::ErrorKind::ResourceBusy;
    use std::os::unix::fs::OpenOptionsExt as _;

    use nix::fcntl::OFlag;

    // Do not wait for a carrier, and do not make the port this process's terminal.
    let flags = OFlag::O_NONBLOCK | OFlag::O_NOCTTY;
    match fs::OpenOptions::new().read(true).write(true).custom_flags(flags.bits()).open(port) {
        Ok(file) => matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)),
        Err(error) => error.kind() == ResourceBusy,
    }
}

impl Link for UsbLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        // A signal does not end a wait for the threads.
        self.threads.exchange(outgoing, incoming, wait.min(HEED)).map_err(|failure| match failure {
            UsbFailure::Gone => LinkError::Unplugged { link: self.name(), at: self.now() },
            other => {
                LinkError::Failed { link: self.name(), at: self.now(), source: std::io::Error::other(other) }
            }
        })
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        Some(self.bytes_per_second)
    }

    fn is_exclusive(&self) -> bool {
        true
    }

    fn waits_for_cts(&self) -> bool {
        self.waits_for_cts
    }

    fn name(&self) -> String {
        self.name.clone()
    }

    fn line_errors(&self) -> LineErrors {
        self.threads.errors()
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown};
    use std::sync::Mutex;

    use nix::unistd::{Gid, Group};

    use super::ftdi::tests::Noting;
    use super::*;
    use crate::UsbDevice;

    /// As behind a hub of USB 1.1 (libftdi's ftdi.c, _ftdi_determine_max_packet_size): 62 bytes of data in each packet of 64.
    #[test]
    fn a_high_speed_chip_at_a_port_of_full_speed_has_short_packets() {
        let packets = [[&[0xb1, 0x60][..], &[7; 62]].concat(), vec![0xb1, 0x60, 8]].concat();
        let mut transport = Noting::without_eeprom(true);
        (transport.packet, transport.says) = (Some(64), Mutex::new([packets].into()));
        let options = UsbOptions::of(&"usb,mode=fifo".parse().unwrap()).unwrap();
        let mut link = UsbLink::over(transport, Chip::Ft2232h, Channel(1), "usb", &options).unwrap();
        let (mut came, begun) = (Vec::new(), Instant::now());
        while came.len() < 63 && begun.elapsed() < Duration::from_secs(60) {
            link.exchange(&[], &mut came, HEED).unwrap();
        }
        assert_eq!(came, [&[7; 62][..], &[8]].concat());
        // At most 19 such packets fit into a frame of 1 ms (USB 2.0, table 5-9).
        assert!(link.bytes_per_second().unwrap() < 19.0 * 62.0 * 1e3);
    }

    /// As behind the rules, which give devices to a group.
    #[test]
    fn who_may_not_open_a_device_of_a_group_is_told_to_join_it() {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::set_permissions(file.path(), fs::Permissions::from_mode(0o660)).unwrap();
        // Only root may; anybody else's files are of a group of their own.
        let _ = chown(file.path(), None, Some(1));
        let group = Gid::from_raw(fs::metadata(file.path()).unwrap().gid());
        let group = Group::from_gid(group).unwrap().unwrap().name;
        let device = UsbDevice {
            vendor_id: 0x0403,
            product_id: 0x6010,
            device_version: 0x0700,
            manufacturer: None,
            product: None,
            serial: None,
            interface: Some(1),
        };
        let board =
            UsbBoard { device, chip: "FT2232H", file: file.path().to_owned(), place: "1-9".to_owned() };
        let told = failed(rusb::Error::Access, &board, Channel(1), "usb").to_string();
        assert!(told.contains(&format!("`sudo usermod -aG {group} $USER`")), "{told}");
    }

    #[test]
    fn a_uart_with_a_handshake_sends_nothing_without_cts() {
        let chip = Chip::Ft2232h;
        for (target, waits) in [("usb", true), ("usb,flow=none", false), ("usb,mode=fifo", false)] {
            let options = UsbOptions::of(&target.parse().unwrap()).unwrap();
            let silent = Noting::without_eeprom(options.mode.is_some());
            let link = UsbLink::over(silent, chip, chip.usual_channel(), target, &options).unwrap();
            assert_eq!(link.waits_for_cts(), waits, "{target}");
        }
    }
}
