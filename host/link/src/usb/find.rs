//! The FTDI chips that are plugged in.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use rusb::{Context, Device, UsbContext as _, Version};
use serde::Serialize;

use super::chip::{Channel, Chip};
use super::error::UsbError;
use super::serial_ports;
use super::transport::UsbFailure;
use crate::ftdi::VENDOR;
use crate::sysfs::{UsbDevice, text};
use crate::{Holder, holders};

/// An FTDI chip that could belong to a board.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UsbBoard {
    /// Its own description, as far as it can be read, and the interface to which boards connect their FPGA.
    pub device: UsbDevice,
    /// The chip, such as `FT2232H`.
    pub chip: &'static str,
    /// Its device file.
    pub file: PathBuf,
    /// Where it is plugged in, such as `1-2.3`: Linux's name, which stays the same for a socket.
    pub place: String,
}

impl UsbBoard {
    /// The target that names it among `all` that are plugged in: its serial number, or its place if it has none of its own or one
    /// with a comma, behind which a target has options.
    pub(crate) fn target(&self, all: &[Self]) -> String {
        let is_own = || all.iter().filter(|one| one.device.serial == self.device.serial).count() == 1;
        let serial = self.device.serial.as_deref();
        let own = serial.filter(|serial| !serial.contains(',') && is_own());
        format!("usb:{}", own.unwrap_or(&self.place))
    }

    /// Other programs that have the board's channel, as far as this user may know: that have opened the serial port that the
    /// system's driver made of it, or the device while somebody has claimed the channel. None if nobody has it.
    #[must_use]
    pub fn holders(&self) -> Option<Vec<Holder>> {
        let channel = Channel(self.device.interface.unwrap_or_default());
        let mut all: Vec<_> =
            serial_ports(&self.place, channel).iter().flat_map(|port| holders(port)).collect();
        let is_claimed = is_claimed(&interface(&self.place, channel));
        if is_claimed {
            all.extend(holders(&self.file));
        }
        (is_claimed || !all.is_empty()).then_some(all)
    }

    fn is_called(&self, name: &str) -> bool {
        self.device.serial.as_deref() == Some(name) || self.place == name
    }
}

impl fmt::Display for UsbBoard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let product = self.device.product.as_deref().unwrap_or("without a name");
        write!(f, "{product}, {} at {}", self.chip, self.place)
    }
}

/// A chip, and the device by which libusb knows it.
pub(super) struct FtdiDevice {
    pub(super) board: UsbBoard,
    pub(super) chip: Chip,
    pub(super) device: Device<Context>,
}

/// All FTDI chips that are plugged in, ordered by place.
///
/// # Errors
/// [`UsbError::NoUsb`]
pub(crate) fn usb_boards() -> Result<Vec<UsbBoard>, UsbError> {
    Ok(all()?.into_iter().map(|found| found.board).collect())
}

fn all() -> Result<Vec<FtdiDevice>, UsbError> {
    // The crate's global context would panic on a machine without USB.
    let context = Context::new().map_err(no_usb)?;
    let devices = context.devices().map_err(no_usb)?;
    let mut found: Vec<FtdiDevice> = devices.iter().filter_map(look_at).collect();
    found.sort_by(|one, other| one.board.place.cmp(&other.board.place));
    Ok(found)
}

fn no_usb(error: rusb::Error) -> UsbError {
    // What a device does is not the matter, so this is none of its failures.
    UsbError::NoUsb(UsbFailure::Other(error.to_string()))
}

fn look_at(device: Device<Context>) -> Option<FtdiDevice> {
    let descriptor = device.device_descriptor().ok()?;
    let version = bcd(descriptor.device_version());
    let chip = (descriptor.vendor_id() == VENDOR).then(|| Chip::of(descriptor.product_id(), version))??;
    let place = place(&device);
    // Linux gives the strings even to users who may not open the device.
    let string = |file: &str| text(&folder_of(&place), file);
    let (serial, product, manufacturer) = (string("serial"), string("product"), string("manufacturer"));
    let (vendor_id, product_id) = (descriptor.vendor_id(), descriptor.product_id());
    let interface = Some(chip.usual_channel().0);
    let described = UsbDevice {
        vendor_id,
        product_id,
        device_version: version,
        manufacturer,
        product,
        serial,
        interface,
    };
    let file = PathBuf::from(format!("/dev/bus/usb/{:03}/{:03}", device.bus_number(), device.address()));
    let board = UsbBoard { device: described, chip: chip.name(), place, file };
    Some(FtdiDevice { board, chip, device })
}

/// A version as in the descriptor: four decimal digits. The first two come as one number here.
fn bcd(Version(major, minor, sub_minor): Version) -> u16 {
    let digits = [major / 10, major % 10, minor, sub_minor];
    digits.into_iter().fold(0, |version, digit| version << 4 | u16::from(digit))
}

/// Linux's folder for the device at `place`.
pub(super) fn folder_of(place: &str) -> PathBuf {
    PathBuf::from("/sys/bus/usb/devices").join(place)
}

/// Linux's folder for the interface of a channel.
pub(super) fn interface(place: &str, channel: Channel) -> PathBuf {
    folder_of(place).join(format!("{place}:1.{}", channel.0))
}

/// Whether a program has claimed the interface of this folder, from which the system's driver is detached as long.
fn is_claimed(interface: &Path) -> bool {
    fs::read_link(interface.join("driver")).is_ok_and(|driver| driver.ends_with("usbfs"))
}

fn place(device: &Device<Context>) -> String {
    let ports: Vec<String> =
        device.port_numbers().unwrap_or_default().iter().map(ToString::to_string).collect();
    format!("{}-{}", device.bus_number(), ports.join("."))
}

/// The chip that `name` stands for: a serial number, a place, or nothing if there is only one high-speed chip; and its target.
pub(super) fn choose(name: Option<&str>) -> Result<(FtdiDevice, String), UsbError> {
    let all = all()?;
    let boards = |found: &[FtdiDevice]| found.iter().map(|found| found.board.clone()).collect();
    let everything: Vec<UsbBoard> = boards(&all);
    let is_meant = |found: &FtdiDevice| match name {
        Some(name) => found.board.is_called(name),
        None => found.chip.is_high_speed(),
    };
    let mut meant: Vec<FtdiDevice> = all.into_iter().filter(is_meant).collect();
    match (meant.pop(), meant.is_empty(), name) {
        (Some(found), true, _) => {
            let target = found.board.target(&everything);
            Ok((found, target))
        }
        (Some(found), false, _) => {
            meant.push(found);
            Err(UsbError::Several(boards(&meant)))
        }
        (None, _, Some(name)) => Err(UsbError::NotFound { wanted: name.to_owned(), found: everything }),
        (None, _, None) if everything.is_empty() => Err(UsbError::NoneFound),
        (None, _, None) => Err(UsbError::OthersOnly(everything)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Target;

    #[test]
    fn a_chip_s_target_leads_to_it_alone() {
        let board = |place: &str, serial: Option<&str>| UsbBoard {
            device: UsbDevice {
                vendor_id: VENDOR,
                product_id: 0x6010,
                device_version: 0x0700,
                manufacturer: None,
                product: None,
                serial: serial.map(str::to_owned),
                interface: Some(0),
            },
            chip: "FT2232H",
            file: PathBuf::new(),
            place: place.to_owned(),
        };
        let serials = [Some("FT1"), Some("FT,1"), Some("FT,mode=fifo"), Some("twice"), Some("twice"), None];
        let all: Vec<_> =
            serials.into_iter().zip(1..).map(|(serial, port)| board(&format!("1-{port}"), serial)).collect();
        let targets: Vec<_> = all.iter().map(|board| board.target(&all)).collect();
        assert_eq!(targets, ["usb:FT1", "usb:1-2", "usb:1-3", "usb:1-4", "usb:1-5", "usb:1-6"]);
        for (target, board) in targets.iter().zip(&all) {
            let target: Target = target.parse().unwrap();
            assert!(target.options.is_empty() && board.is_called(&target.address.unwrap()));
        }
    }

    /// As the links of sysfs look while libusb has claimed an interface, and while the serial driver has it.
    #[test]
    fn an_interface_that_a_program_has_claimed_is_seen_without_opening_it() {
        let interface = tempfile::tempdir().unwrap();
        let driver = interface.path().join("driver");
        assert!(!is_claimed(interface.path()));
        std::os::unix::fs::symlink("../../../../bus/usb/drivers/ftdi_sio", &driver).unwrap();
        assert!(!is_claimed(interface.path()));
        fs::remove_file(&driver).unwrap();
        std::os::unix::fs::symlink("../../../../bus/usb/drivers/usbfs", &driver).unwrap();
        assert!(is_claimed(interface.path()));
    }

    #[test]
    fn a_version_is_the_descriptor_s_own() {
        // Those of an FT2232H and an FT230X, and one with four different digits.
        for version in [0x0700, 0x1000, 0x1234] {
            assert_eq!(bcd(Version::from_bcd(version)), version);
        }
    }
}
