//! Whether a device file may be opened, without opening it, and what to do if not.

use std::fs;
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;

use nix::errno::Errno;
use nix::unistd::{AccessFlags, access};

use crate::UsbDevice;
use crate::ftdi;

/// Who keeps a device file from being opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// This user may not open it.
    FromUser,
    /// This program is not given it, as in a container to which it was not passed on.
    FromProgram,
}

impl Kept {
    /// Whether `file`, that of a device that is there, is kept from being opened. Opening it could wake the device, or reset a board.
    pub(crate) fn is(file: &Path) -> Option<Self> {
        match access(file, AccessFlags::R_OK | AccessFlags::W_OK) {
            Ok(()) => None,
            // Only the control group of a container or service says EPERM.
            Err(Errno::ENOENT | Errno::EPERM) => Some(Self::FromProgram),
            Err(_) => Some(Self::FromUser),
        }
    }

    /// What to do about `file`, that of a port or of the USB device `usb` itself.
    pub(crate) fn remedy(self, file: &Path, usb: Option<&UsbDevice>) -> String {
        match self {
            Self::FromUser => how_to_get_access(file, usb),
            Self::FromProgram => HAVE_IT.to_owned(),
        }
    }
}

/// What to do about a device that is there but not given to this program.
pub(crate) const HAVE_IT: &str =
    "let the container or service that this program runs in have it, as docs/install.md says";

/// What to do about a device file that this user may not open, that of a port or of the USB device `usb` itself.
#[must_use]
pub(crate) fn how_to_get_access(file: &Path, usb: Option<&UsbDevice>) -> String {
    let group = fs::metadata(file).ok().filter(|file| file.mode() & 0o060 == 0o060).map(|file| file.gid());
    let group = group.filter(|&id| id != 0);
    let group = group.and_then(|id| nix::unistd::Group::from_gid(id.into()).ok().flatten());
    let join = group
        .map(|group| format!("join its group with `sudo usermod -aG {} $USER` and log in again", group.name));
    // The rules name no other devices.
    let has_rule =
        |usb: &&UsbDevice| usb.vendor_id == ftdi::VENDOR && ftdi::PRODUCTS.contains(&usb.product_id);
    let install =
        usb.filter(has_rule).map(|_| "install scripts/70-halfrow.rules as docs/boards.md says".to_owned());
    let ways: Vec<String> = join.into_iter().chain(install).collect();
    if ways.is_empty() { "ask root for read and write access to it".to_owned() } else { ways.join(", or ") }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    /// Root may open any file.
    #[test]
    fn a_file_is_not_opened_to_find_out_who_may() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert_eq!(Kept::is(&pipe), Some(Kept::FromProgram));
        assert_eq!(Kept::FromProgram.remedy(&pipe, None), HAVE_IT);
        // Whoever opens a pipe to read waits until somebody writes.
        nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::from_bits_truncate(0o400)).unwrap();
        let kept = if nix::unistd::geteuid().is_root() { None } else { Some(Kept::FromUser) };
        assert_eq!(Kept::is(&pipe), kept);
    }

    #[test]
    fn the_rules_are_recommended_only_for_the_chips_that_they_name() {
        let usb = |vendor_id, product_id| UsbDevice {
            vendor_id,
            product_id,
            device_version: 0,
            manufacturer: None,
            product: None,
            serial: None,
            interface: None,
        };
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::set_permissions(file.path(), fs::Permissions::from_mode(0o600)).unwrap();
        let rules = "install scripts/70-halfrow.rules as docs/boards.md says";
        for (device, remedy) in [
            (Some(usb(0x0403, 0x6001)), rules),
            (Some(usb(0x0403, 0x6010)), rules),
            // A CP2102, a chip of FTDI's of another kind, and a port without USB.
            (Some(usb(0x10c4, 0xea60)), "ask root for read and write access to it"),
            (Some(usb(0x0403, 0x6041)), "ask root for read and write access to it"),
            (None, "ask root for read and write access to it"),
        ] {
            assert_eq!(how_to_get_access(file.path(), device.as_ref()), remedy);
        }
    }
}
