//! The FT232B that QEMU emulates: a chip that this project did not make.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Read as _, Write as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use halfrow_ft2232h::FarEnd as _;
use nix::fcntl::OFlag;

use super::{BytesSent, MockAtChip};
use crate::parallel::end_beside;
use crate::patience::wait_until;

const SERIAL: &str = "QEMU0001";

/// The target of this chip.
pub const QEMU_CHIP: &str = "usb:QEMU0001";

/// A mock board behind QEMU's chip, until it is dropped.
#[derive(Debug)]
pub struct QemuBoard {
    is_over: Arc<AtomicBool>,
    said: BytesSent,
    thread: Option<JoinHandle<()>>,
}

impl QemuBoard {
    /// The mock board that `options`, like those of a target, describe. QEMU has one chip, so only one such board can exist at a
    /// time.
    ///
    /// # Panics
    /// Without the port that `scripts/in-linux` gives to the guest.
    #[must_use]
    pub fn new(options: &str) -> Self {
        wait_until("QEMU's chip to be there", is_there);
        let (port, board) = (port("usb-serial"), MockAtChip::new(options));
        let is_over = Arc::new(AtomicBool::new(false));
        let (over, said) = (Arc::clone(&is_over), board.said.clone());
        Self { is_over, said, thread: Some(thread::spawn(move || serve(port, board, &over))) }
    }

    /// The count of what it sends.
    #[must_use]
    pub fn said(&self) -> &BytesSent {
        &self.said
    }
}

impl Drop for QemuBoard {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        end_beside(self.thread.take());
    }
}

/// Carries bytes both ways, and waits for neither: QEMU halts when nobody reads what its chip sends.
fn serve(mut port: File, mut board: MockAtChip, is_over: &AtomicBool) {
    let begun = Instant::now();
    let (mut to_board, mut to_host) = (Vec::new(), Vec::new());
    let mut buffer = [0; 4096];
    while !is_over.load(Ordering::Relaxed) {
        let read = ready(port.read(&mut buffer));
        to_board.extend_from_slice(&buffer[..read]);
        let Ok(taken) = board.exchange(&to_board, &mut to_host, begun.elapsed()) else { return };
        to_board.drain(..taken);
        let written = if to_host.is_empty() { 0 } else { ready(port.write(&to_host)) };
        to_host.drain(..written);
        if read + taken + written == 0 {
            thread::sleep(Duration::from_micros(200));
        }
    }
}

/// How many bytes were moved; 0 if the port is not ready.
fn ready(moved: std::io::Result<usize>) -> usize {
    match moved {
        Err(error) if error.kind() == ErrorKind::WouldBlock => 0,
        moved => moved.unwrap(),
    }
}

/// The port of this name between guest and QEMU.
fn port(name: &str) -> File {
    let ports = fs::read_dir("/sys/class/virtio-ports").unwrap().flatten();
    let is_it =
        |folder: &Path| fs::read_to_string(folder.join("name")).is_ok_and(|found| found.trim() == name);
    let folder = ports.map(|entry| entry.path()).find(|folder| is_it(folder)).unwrap();
    let device = PathBuf::from("/dev").join(folder.file_name().unwrap());
    OpenOptions::new().read(true).write(true).custom_flags(OFlag::O_NONBLOCK.bits()).open(device).unwrap()
}

/// Sends `command` to QEMU's own monitor.
fn say(command: &str) {
    let mut monitor = port("monitor");
    monitor.write_all(format!("{command}\n").as_bytes()).unwrap();
}

/// Keeps QEMU's chip unplugged until it is dropped, whatever happens to the test: others need the chip.
#[derive(Debug)]
pub struct QemuChipOut(());

impl QemuChipOut {
    /// Pulls it out.
    ///
    /// # Panics
    /// If it stays.
    #[must_use]
    pub fn pull() -> Self {
        let out = Self(());
        say("device_del chip");
        wait_until("QEMU's chip to be gone", || !is_there());
        out
    }
}

impl Drop for QemuChipOut {
    /// Plugs it in again. Whoever needs it waits until the kernel sees it.
    fn drop(&mut self) {
        say(&format!(
            "device_add usb-serial,id=chip,bus=xhci.0,chardev=far,serial={SERIAL},always-plugged=on"
        ));
    }
}

/// Whether the kernel sees QEMU's chip.
fn is_there() -> bool {
    let serials = fs::read_dir("/sys/bus/usb/devices").unwrap().flatten();
    serials
        .filter_map(|device| fs::read_to_string(device.path().join("serial")).ok())
        .any(|serial| serial.trim() == SERIAL)
}
