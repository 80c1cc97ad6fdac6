//! What the kernel knows about USB devices, and about ports that are not in /dev.

use std::fs;
use std::path::{Path, PathBuf};

/// A USB device: the one that a serial port belongs to, or a chip that has no port.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct UsbDevice {
    /// Vendor id.
    pub vendor_id: u16,
    /// Product id.
    pub product_id: u16,
    /// The device's version, `bcdDevice`, which tells FTDI's chips apart.
    pub device_version: u16,
    /// The manufacturer's name.
    pub manufacturer: Option<String>,
    /// The product's name.
    pub product: Option<String>,
    /// The serial number.
    pub serial: Option<String>,
    /// The USB interface of that port; of a chip, the one to which boards connect their FPGA.
    pub interface: Option<u8>,
}

/// The USB device behind the serial port `port`, a path that may be a link; none if the port is not on USB.
#[must_use]
pub(crate) fn usb_device(port: &Path) -> Option<UsbDevice> {
    let device = fs::canonicalize(port).ok()?;
    usb_device_in(&Path::new("/sys/class/tty").join(device.file_name()?))
}

/// The same, given the port's folder in sysfs, `class`.
fn usb_device_in(class: &Path) -> Option<UsbDevice> {
    let mut interface = None;
    let mut folder: PathBuf = fs::canonicalize(class.join("device")).ok()?;
    loop {
        interface = interface.or_else(|| number(&folder, "bInterfaceNumber"));
        if let Some(vendor_id) = number(&folder, "idVendor") {
            return Some(UsbDevice {
                vendor_id,
                product_id: number(&folder, "idProduct")?,
                device_version: number(&folder, "bcdDevice").unwrap_or_default(),
                manufacturer: text(&folder, "manufacturer"),
                product: text(&folder, "product"),
                serial: text(&folder, "serial"),
                interface: interface.and_then(|interface| u8::try_from(interface).ok()),
            });
        }
        if !folder.pop() {
            return None;
        }
    }
}

/// Whether the kernel has the port `port`, which is not among this program's devices, as in a container to which it was not passed
/// on.
pub(crate) fn is_without_file(port: &Path) -> bool {
    is_without_file_in(Path::new("/dev"), Path::new("/sys/class/tty"), port)
}

/// The same, given the folders of devices and of ports.
fn is_without_file_in(devices: &Path, class: &Path, port: &Path) -> bool {
    let name = port.file_name().filter(|_| port.parent() == Some(devices) && !port.exists());
    name.is_some_and(|name| class.join(name).exists())
}

/// What a file of a folder says; none if it is empty or not there.
pub(crate) fn text(folder: &Path, file: &str) -> Option<String> {
    let text = fs::read_to_string(folder.join(file)).ok()?;
    Some(text.trim().to_owned()).filter(|text| !text.is_empty())
}

fn number(folder: &Path, file: &str) -> Option<u16> {
    u16::from_str_radix(&text(folder, file)?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_device_is_found_above_its_interface() {
        let root = tempfile::tempdir().unwrap();
        let device = root.path().join("usb1/1-2");
        let port = device.join("1-2:1.1/ttyUSB1");
        fs::create_dir_all(&port).unwrap();
        let file = |path: &Path, name: &str, content: &str| fs::write(path.join(name), content).unwrap();
        file(&device, "idVendor", "0403\n");
        file(&device, "idProduct", "6010\n");
        file(&device, "bcdDevice", "0700\n");
        file(&device, "serial", "FT3XYZ\n");
        file(&device, "product", "\n");
        file(&device.join("1-2:1.1"), "bInterfaceNumber", "01\n");
        let class = root.path().join("class/ttyUSB1");
        fs::create_dir_all(&class).unwrap();
        std::os::unix::fs::symlink(&port, class.join("device")).unwrap();
        let found = usb_device_in(&class).unwrap();
        assert_eq!((found.vendor_id, found.product_id, found.device_version), (0x0403, 0x6010, 0x0700));
        assert_eq!(
            (found.serial.as_deref(), found.product, found.interface),
            (Some("FT3XYZ"), None, Some(1))
        );
    }

    #[test]
    fn a_port_that_is_kept_from_this_program_is_told_from_one_that_is_not_there() {
        let root = tempfile::tempdir().unwrap();
        let (devices, class) = (root.path().join("dev"), root.path().join("class"));
        fs::create_dir_all(&devices).unwrap();
        for port in ["ttyUSB0", "ttyUSB1"] {
            fs::create_dir_all(class.join(port)).unwrap();
        }
        fs::write(devices.join("ttyUSB0"), "").unwrap();
        let is_without_file = |port: &str| is_without_file_in(&devices, &class, &devices.join(port));
        assert!(is_without_file("ttyUSB1"));
        assert!(!is_without_file("ttyUSB0") && !is_without_file("ttyUSB2"));
        assert!(!is_without_file_in(&devices, &class, Path::new("ttyUSB1")));
    }

    #[test]
    fn a_port_without_usb_has_no_usb_device() {
        assert_eq!(usb_device(Path::new("/dev/null")), None);
        assert_eq!(usb_device(Path::new("/dev/not-there")), None);
    }
}
