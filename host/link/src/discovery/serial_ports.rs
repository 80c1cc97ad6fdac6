//! Serial ports, by names that stay the same when another board is plugged in first.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Access, Found};
use crate::access::Kept;
use crate::sysfs::is_without_file;
use crate::target::BoardKind;
use crate::{UsbDevice, holders, usb_device};

/// Where udev keeps stable names, the better ones first: a serial number goes with the board, a path with the socket.
const NAMES: [&str; 2] = ["/dev/serial/by-id", "/dev/serial/by-path"];

/// The serial ports of this computer.
pub(crate) fn find() -> Vec<Found> {
    // The list of serialport panics without this folder.
    if !Path::new("/sys/class/tty").is_dir() {
        return Vec::new();
    }
    let ports = serialport::available_ports().unwrap_or_else(|error| {
        tracing::warn!("the serial ports cannot be listed: {error}");
        Vec::new()
    });
    let mut found: Vec<_> = ports.iter().map(|port| look_at(Path::new(&port.port_name))).collect();
    found.sort_by_key(|port| (port.usb.is_none(), port.device.clone()));
    found
}

/// Describes the port `path` without opening it: that would raise its modem lines, which resets some boards.
pub(super) fn look_at(path: &Path) -> Found {
    let names: Vec<_> = NAMES.iter().flat_map(|folder| names_in(Path::new(folder), path)).collect();
    let usb = usb_device(path);
    Found {
        target: format!("serial:{}", names.first().map_or(path, PathBuf::as_path).display()),
        kind: BoardKind::Hardware,
        summary: usb.as_ref().map_or_else(|| "a serial port without USB".to_owned(), summary),
        device: Some(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())),
        names,
        access: access_to(path, usb.as_ref()),
        usb,
        answer: None,
    }
}

fn access_to(path: &Path, usb: Option<&UsbDevice>) -> Access {
    if !path.exists() && !is_without_file(path) {
        return Access::Missing;
    }
    if let Some(kept) = Kept::is(path) {
        return Access::Denied { remedy: kept.remedy(path, usb) };
    }
    let holders = holders(path);
    if holders.is_empty() { Access::Free } else { Access::Busy { holders } }
}

/// The links in `folder` that lead to `device`.
fn names_in(folder: &Path, device: &Path) -> Vec<PathBuf> {
    let Ok(device) = fs::canonicalize(device) else { return Vec::new() };
    let links = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut names: Vec<_> =
        links.filter(|link| fs::canonicalize(link).is_ok_and(|target| target == device)).collect();
    names.sort();
    names
}

fn summary(usb: &UsbDevice) -> String {
    let UsbDevice { vendor_id, product_id, manufacturer, product, serial, interface, .. } = usb;
    let maker = manufacturer.as_deref().map(|maker| format!("{maker} ")).unwrap_or_default();
    let product = product.as_deref().unwrap_or("USB device");
    let mut text = format!("{maker}{product} ({vendor_id:04x}:{product_id:04x})");
    if let Some(serial) = serial {
        text += &format!(", serial number {serial}");
    }
    if let Some(interface) = interface {
        text += &format!(", interface {interface}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_lead_to_the_device_are_found() {
        let root = tempfile::tempdir().unwrap();
        let (device, other) = (root.path().join("ttyUSB1"), root.path().join("ttyUSB2"));
        fs::write(&device, "").unwrap();
        fs::write(&other, "").unwrap();
        let folder = root.path().join("by-id");
        fs::create_dir(&folder).unwrap();
        for (name, target) in [("usb-B", &device), ("usb-A", &device), ("usb-C", &other)] {
            std::os::unix::fs::symlink(target, folder.join(name)).unwrap();
        }
        assert_eq!(names_in(&folder, &device), [folder.join("usb-A"), folder.join("usb-B")]);
        assert!(names_in(&root.path().join("not-there"), &device).is_empty());
    }

    #[test]
    fn a_usb_port_is_described_by_what_its_device_says() {
        let mut usb = UsbDevice {
            vendor_id: 0x0403,
            product_id: 0x6010,
            device_version: 0x0700,
            manufacturer: Some("Scarab".to_owned()),
            product: Some("miniSpartan6+".to_owned()),
            serial: Some("FT3XYZ".to_owned()),
            interface: Some(1),
        };
        assert_eq!(summary(&usb), "Scarab miniSpartan6+ (0403:6010), serial number FT3XYZ, interface 1");
        usb = UsbDevice { manufacturer: None, product: None, serial: None, interface: None, ..usb };
        assert_eq!(summary(&usb), "USB device (0403:6010)");
    }
}
