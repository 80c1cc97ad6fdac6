//! What a service tells systemd (`sd_notify(3)`): that it is ready, and that it works.

use std::os::linux::net::SocketAddrExt as _;
use std::os::unix::net::{SocketAddr, UnixDatagram};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// The time that `TimeoutStartSec` of the unit gives a start, and how often it is asked for again.
const MORE_TIME: &str = "EXTEND_TIMEOUT_USEC=300000000";
const ASK: Duration = Duration::from_secs(10);

/// systemd's socket, if there is one.
#[derive(Debug, Default)]
pub(super) struct Notify(Option<(UnixDatagram, SocketAddr)>);

impl Notify {
    /// The socket that the environment names.
    pub(super) fn of_environment() -> Self {
        Self(std::env::var("NOTIFY_SOCKET").ok().and_then(|name| {
            let address = match name.strip_prefix('@') {
                Some(name) => SocketAddr::from_abstract_name(name),
                None => SocketAddr::from_pathname(&name),
            };
            Some((UnixDatagram::unbound().ok()?, address.ok()?))
        }))
    }

    /// Calls `open`, which may have to read or copy a database of any size, and asks systemd for more time to start
    /// meanwhile.
    pub(super) fn while_opening<T>(&self, open: impl FnOnce() -> T) -> T {
        if self.0.is_none() {
            return open();
        }
        thread::scope(|scope| {
            let (under_way, ended) = mpsc::channel::<()>();
            scope.spawn(move || {
                self.tell(MORE_TIME);
                while ended.recv_timeout(ASK) == Err(RecvTimeoutError::Timeout) {
                    self.tell(MORE_TIME);
                }
            });
            let opened = open();
            drop(under_way);
            opened
        })
    }

    /// Says that the station takes scans.
    pub(super) fn ready(&self) {
        self.tell("READY=1");
    }

    /// Says that the engine works. systemd restarts a service that it does not hear from for a while.
    pub(super) fn works(&self) {
        self.tell("WATCHDOG=1");
    }

    /// What is told in place of systemd's own socket, at one in `folder`.
    #[cfg(test)]
    pub(super) fn heard_in(folder: &std::path::Path) -> (UnixDatagram, Self) {
        let path = folder.join("notify");
        let systemd = UnixDatagram::bind(&path).unwrap();
        let address = SocketAddr::from_pathname(path).unwrap();
        (systemd, Self(Some((UnixDatagram::unbound().unwrap(), address))))
    }

    fn tell(&self, what: &str) {
        if let Some((socket, address)) = &self.0
            && let Err(error) = socket.send_to_addr(what.as_bytes(), address)
        {
            tracing::warn!("systemd was not told {what}: {error}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_socket_hears_what_systemd_would() {
        let folder = tempfile::tempdir().unwrap();
        let (systemd, notify) = Notify::heard_in(folder.path());
        notify.ready();
        notify.works();
        let heard = || {
            let mut buffer = [0; 64];
            let read = systemd.recv(&mut buffer).unwrap();
            String::from_utf8(buffer[..read].to_vec()).unwrap()
        };
        assert_eq!([heard(), heard()], ["READY=1", "WATCHDOG=1"]);
    }
}
