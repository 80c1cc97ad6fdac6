//! A chip in a port of the kernel's `vhci-hcd`.

use std::fs;
use std::io::{self, BufReader};
use std::os::fd::AsRawFd as _;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::chip::Chip;
use crate::server::Server;
use crate::urb::Command;

const CONTROLLER: &str = "/sys/devices/platform/vhci_hcd.0";

const DEVICES: &str = "/sys/bus/usb/devices";

/// Full and high speed, by the kernel's numbers for them.
const FULL_SPEED: u32 = 2;
const HIGH_SPEED: u32 = 3;

/// The kernel names a device, and frees a port, however busy it is; only a hang takes longer.
const PATIENCE: Duration = Duration::from_secs(300);

/// A chip that is plugged in until it is dropped.
pub struct Plugged {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
    port: u32,
    bus_name: String,
}

struct Shared {
    server: Mutex<Server>,
    /// Signalled when something changes that may end the wait for the next tick.
    changed: Condvar,
}

impl Shared {
    fn server(&self) -> MutexGuard<'_, Server> {
        self.server.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn listen(&self, socket: UnixStream) {
        let mut socket = BufReader::with_capacity(1 << 16, socket);
        while let Ok(command) = Command::read(&mut socket) {
            self.server().take(command);
            self.changed.notify_one();
        }
        self.server().unplug();
        self.changed.notify_one();
    }

    fn tick(&self) {
        let mut server = self.server();
        while !server.is_gone {
            let wait = server.serve().unwrap_or(Duration::from_secs(1));
            server = match self.changed.wait_timeout(server, wait) {
                Ok((server, _)) => server,
                Err(poisoned) => poisoned.into_inner().0,
            };
        }
    }
}

impl Plugged {
    /// Plugs `chip` into the high-speed port `port`, 0 to 7, and waits until the kernel has given it a name. A driver may bind
    /// later.
    ///
    /// # Errors
    /// Without `vhci-hcd`, without being root, with the port taken, or when the kernel does not take the chip.
    pub fn new(chip: Chip, port: u32) -> io::Result<Self> {
        let speed = if chip.is_slowed() { FULL_SPEED } else { HIGH_SPEED };
        let (ours, kernels) = UnixStream::pair()?;
        let server = Mutex::new(Server::new(chip, ours.try_clone()?));
        let shared = Arc::new(Shared { server, changed: Condvar::new() });
        let attach = format!("{port} {} {} {speed}", kernels.as_raw_fd(), 65536 + port + 1);
        fs::write(Path::new(CONTROLLER).join("attach"), attach)?;
        let (listening, ticking) = (Arc::clone(&shared), Arc::clone(&shared));
        let threads =
            vec![thread::spawn(move || listening.listen(ours)), thread::spawn(move || ticking.tick())];
        let mut plugged = Self { shared, threads, port, bus_name: String::new() };
        plugged.wait("no name from the kernel", || plugged.name_now().is_some())?;
        plugged.bus_name = plugged.name_now().unwrap_or_default();
        Ok(plugged)
    }

    /// The kernel's name for it, such as `1-1`.
    #[must_use]
    pub fn bus_name(&self) -> &str {
        &self.bus_name
    }

    fn name_now(&self) -> Option<String> {
        // One line a port: hub, port, state (6: in use), speed, device, socket, name.
        let line = self.status_line()?;
        let fields: Vec<&str> = line.split_whitespace().collect();
        let name = fields.get(6).filter(|_| fields.get(2) == Some(&"006"))?;
        Path::new(DEVICES).join(name).join("idProduct").exists().then(|| (*name).to_owned())
    }

    fn status_line(&self) -> Option<String> {
        let status = fs::read_to_string(Path::new(CONTROLLER).join("status")).ok()?;
        let port = format!("{:04}", self.port);
        status.lines().find(|line| line.split_whitespace().nth(1) == Some(&port)).map(str::to_owned)
    }

    /// Whether a host can still talk to it.
    #[must_use]
    pub fn is_plugged(&self) -> bool {
        !self.shared.server().is_gone
    }

    /// Pulls it out.
    pub fn unplug(&self) {
        self.shared.server().unplug();
        self.shared.changed.notify_one();
    }

    fn wait(&self, what: &str, is_done: impl Fn() -> bool) -> io::Result<()> {
        let begun = Instant::now();
        while !is_done() {
            if begun.elapsed() > PATIENCE {
                return Err(io::Error::new(io::ErrorKind::TimedOut, format!("port {}: {what}", self.port)));
            }
            thread::sleep(Duration::from_millis(2));
        }
        Ok(())
    }
}

impl Drop for Plugged {
    /// Waits until the port can be used again: while the old device exists, the hub takes a new one for it.
    #[allow(clippy::print_stderr)]
    fn drop(&mut self) {
        let folder = Path::new(DEVICES).join(&self.bus_name);
        self.unplug();
        for thread in self.threads.drain(..) {
            // A thread that panicked has printed why.
            let _ = thread.join();
        }
        let is_free = || {
            self.status_line().is_none_or(|line| line.split_whitespace().nth(2) == Some("004"))
                && (self.bus_name.is_empty() || !folder.exists())
        };
        if let Err(error) = self.wait("the kernel still holds it", is_free) {
            eprintln!("{error}");
        }
    }
}
