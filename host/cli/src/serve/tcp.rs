//! A TCP port that takes one host at a time.

use std::io::{self, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::AsRawFd;
use std::str::FromStr;
use std::thread;
use std::time::{Duration, Instant};

use super::{Hosted, ServeError, Traffic};
use halfrow::link::descriptor::{is_ready, never_block};

/// How often to check whether to end while nobody is connected.
const TICK: Duration = Duration::from_millis(50);

/// How long a second host waits for the first to leave. A host that was killed leaves only when everything that it sent is read.
const GRACE: Duration = Duration::from_millis(100);

/// When a host that is connected but silent gives way to another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    /// How long it may be connected before its first packet.
    pub(super) unheard: Duration,
    /// How long it may be silent after its last packet: as long as the protocol lets it hold the board.
    pub(super) silent: Duration,
}

const PATIENCE: Patience = Patience { unheard: Duration::from_secs(2), silent: Duration::from_secs(10) };

/// What ser2net sends to a second host, so that hosts need not tell the two apart.
const IN_USE: &[u8] = b"Port already in use\r\n";

/// Where to listen: a host and a port, or a PORT that only this computer can reach. Port 0 is any free port. Whether the host is this
/// computer shows when it is listened on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TcpPlace(String);

/// A text that is no [`TcpPlace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give PORT or ADDRESS:PORT, with a port of 0 to 65535")]
pub struct NoTcpPlace;

impl FromStr for TcpPlace {
    type Err = NoTcpPlace;

    fn from_str(text: &str) -> Result<Self, NoTcpPlace> {
        let (host, port) = text.rsplit_once(':').unwrap_or(("127.0.0.1", text));
        match port.parse::<u16>() {
            Ok(port) if !host.is_empty() => Ok(Self(format!("{host}:{port}"))),
            _ => Err(NoTcpPlace),
        }
    }
}

/// A TCP port that is listened on.
#[derive(Debug)]
pub struct Port {
    listener: TcpListener,
    pub(super) patience: Patience,
}

impl Patience {
    /// Whether a host gives way that connected at `connected` and was last heard at `heard`.
    fn ends(self, connected: Instant, heard: Option<Instant>) -> bool {
        match heard {
            Some(heard) => heard.elapsed() >= self.silent,
            None => connected.elapsed() >= self.unheard,
        }
    }
}

impl Port {
    /// Listens on `place`.
    ///
    /// # Errors
    /// [`ServeError::Door`] when it is taken or not this computer's.
    pub fn listen(TcpPlace(address): &TcpPlace) -> Result<Self, ServeError> {
        let listen = || {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            Ok(Self { listener, patience: PATIENCE })
        };
        listen().map_err(|source| ServeError::Door { what: format!("the TCP port {address}"), source })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// [`ServeError::Door`] when the system does not say.
    pub fn address(&self) -> Result<SocketAddr, ServeError> {
        let unknown = |source| ServeError::Door { what: "the TCP port".to_owned(), source };
        self.listener.local_addr().map_err(unknown)
    }

    /// Serves `board` to one host after the other, until `ended` says so. Other hosts are turned away meanwhile. But if the
    /// connected host has sent no packet for some seconds, it is turned away and the next one served.
    ///
    /// # Errors
    /// [`ServeError::Board`] when the board is gone.
    pub fn serve(
        &self,
        board: &mut Hosted,
        ended: &mut dyn FnMut(Traffic) -> bool,
    ) -> Result<(), ServeError> {
        let mut entrance = Entrance { listener: &self.listener, is_shut: false };
        let mut next: Option<(TcpStream, Instant)> = None;
        while !ended(Traffic::default()) {
            let Some(host) = next.take().map(|(host, _)| host).or_else(|| entrance.accept()) else {
                entrance.wait();
                continue;
            };
            let connected = Instant::now();
            board.attend(&host, &mut |traffic| {
                if next.is_none() {
                    next = entrance.accept().map(|host| (host, Instant::now()));
                }
                if next.is_some() && self.patience.ends(connected, traffic.heard) {
                    tracing::info!("{} is turned away: it was silent, and another host waits", name(&host));
                    return true;
                }
                if let Some((mut host, _)) = next.take_if(|(_, since)| since.elapsed() > GRACE) {
                    tracing::info!("{} is turned away: another host has the board", name(&host));
                    // A host that does not wait for this answer does not need it.
                    let _ = host.write_all(IN_USE);
                }
                ended(traffic)
            })?;
        }
        Ok(())
    }
}

/// Where `host` is, for the log.
fn name(host: &TcpStream) -> String {
    host.peer_addr().map_or_else(|_| "a host".to_owned(), |address| address.to_string())
}

/// The listener that lets hosts in.
struct Entrance<'a> {
    listener: &'a TcpListener,
    /// Whether the system lets nobody in. This has then been logged.
    is_shut: bool,
}

impl Entrance<'_> {
    fn accept(&mut self) -> Option<TcpStream> {
        use io::ErrorKind::{ConnectionAborted, Interrupted, WouldBlock};
        let accepted = self.listener.accept();
        let shut = accepted.as_ref().err();
        let shut = shut.filter(|error| !matches!(error.kind(), WouldBlock | Interrupted | ConnectionAborted));
        if let Some(error) = shut.filter(|_| !self.is_shut) {
            tracing::warn!(
                "no host can be let in: {error}; end other programs, or allow this one more open files (ulimit -n)"
            );
        }
        self.is_shut = shut.is_some();
        let (host, from) = accepted.ok()?;
        host.set_nodelay(true).ok()?;
        never_block(host.as_raw_fd()).ok()?;
        tracing::info!("{from} has connected");
        Some(host)
    }

    /// Waits for the next host, or a tick. While hosts cannot be let in, the listener is always ready, so this only sleeps.
    fn wait(&self) {
        if self.is_shut {
            thread::sleep(TICK);
        } else {
            let _ = is_ready(self.listener.as_raw_fd(), false, TICK);
        }
    }
}
