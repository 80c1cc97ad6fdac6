//! A TCP connection as a link to a board that another computer exports as raw bytes, for example with ser2net.

use std::io;
use std::net::{SocketAddr, TcpStream, ToSocketAddrs};
use std::os::fd::AsRawFd;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use super::descriptor::{Gone, Pump, never_block};
use super::{HEED, Link, LinkError, OpenError, bytes_per_second};
use crate::Class;
use crate::options::{positive, read, set};
use crate::target::Target;

/// The limit for each address of the host. In a laboratory a connection takes a millisecond, around the world a third of a
/// second.
const PATIENCE: Duration = Duration::from_secs(3);

/// The limit for the host's name: enough for a second name server where the first one is off (resolv.conf(5): five seconds).
const RESOLVED: Duration = Duration::from_secs(15);

/// The longest text that is kept of a server that sends words instead of a board's bytes.
const LONGEST_TEXT: usize = 200;

/// A connection that did not come about.
#[derive(Debug, thiserror::Error)]
pub enum TcpError {
    /// The address is not a host and a port.
    #[error("`{0}` is no host and port; write tcp:HOST:PORT, and tcp:[ADDRESS]:PORT for an IPv6 address")]
    Address(String),
    /// The name of the host cannot be resolved to an address.
    #[error("the host of `{address}` is not known; check its name, or give its IP address")]
    UnknownHost {
        /// Host and port.
        address: String,
        /// Why.
        #[source]
        source: io::Error,
    },
    /// The host is there, but nothing listens on this port.
    #[error(
        "`{0}` refuses connections: the host is there, and nothing listens on that port; start ser2net or `halfrow \
         serve` there, and check the port"
    )]
    Refused(String),
    /// The host does not answer.
    #[error(
        "`{address}` does not answer within {} s: the host is off, or a firewall drops what is sent to that port",
        seconds.as_secs()
    )]
    Silent {
        /// Host and port.
        address: String,
        /// How long each of its addresses was tried.
        seconds: Duration,
    },
    /// The host cannot be reached, or ends the connection at once.
    #[error(
        "`{address}` cannot be reached; check this computer's network, and the program that waits for connections there"
    )]
    Unreachable {
        /// Host and port.
        address: String,
        /// Why.
        #[source]
        source: io::Error,
    },
}

impl TcpError {
    /// Who can do something about it.
    #[must_use]
    pub fn class(&self) -> Class {
        if matches!(self, Self::Address(_)) { Class::Call } else { Class::Station }
    }
}

/// A pipe to a board behind a TCP connection.
#[derive(Debug)]
pub(crate) struct TcpLink {
    stream: TcpStream,
    pump: Pump,
    address: String,
    baud: Option<u32>,
    opened: Instant,
    /// The bytes before the first zero byte. Every packet of a board begins with a zero.
    text: Vec<u8>,
    zero_seen: bool,
}

impl TcpLink {
    /// Checks that `target` names a host and a port, with options of this kind.
    pub(crate) fn check(target: &Target) -> Result<(), OpenError> {
        asked(target).map(drop)
    }

    /// Connects to the host and port of a `tcp:HOST:PORT` target.
    ///
    /// # Errors
    /// [`OpenError`] when the target is no such target, or no connection can be made.
    pub(crate) fn open(target: &Target) -> Result<Self, OpenError> {
        let (address, baud) = asked(target)?;
        let stream = connect(&address)?;
        let refused = |source| OpenError::System { target: target.to_string(), source };
        stream.set_nodelay(true).and_then(|()| never_block(stream.as_raw_fd())).map_err(refused)?;
        let (pump, opened) = (Pump::default(), Instant::now());
        Ok(Self { stream, pump, address, baud, opened, text: Vec::new(), zero_seen: false })
    }

    /// Keeps text that comes in place of packets.
    fn listen(&mut self, received: &[u8]) {
        if self.zero_seen {
            return;
        }
        let text = received.split(|&byte| byte == 0).next().unwrap_or_default();
        self.zero_seen = text.len() < received.len();
        self.text.extend_from_slice(text);
        self.text.truncate(LONGEST_TEXT);
    }

    fn closed(&self) -> LinkError {
        let (link, at) = (self.name(), self.now());
        match words(&self.text).map(str::to_owned) {
            // ser2net says `Port already in use` of its own port, and `Object was already in use` of its device.
            Some(text) if !self.zero_seen && text.contains("in use") => LinkError::InUse { link, text },
            Some(text) if !self.zero_seen => LinkError::NoBoardThere { link, text },
            _ => LinkError::ClosedAfar { link, at },
        }
    }
}

impl Link for TcpLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let before = incoming.len();
        let moved = self.pump.exchange(self.stream.as_raw_fd(), outgoing, incoming, wait.min(HEED));
        self.listen(&incoming[before..]);
        moved.map_err(|gone| match gone {
            Gone::HungUp => self.closed(),
            Gone::Failed(source) => LinkError::Failed { link: self.name(), at: self.now(), source },
        })
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        self.baud.map(bytes_per_second)
    }

    fn name(&self) -> String {
        format!("the connection to {}", self.address)
    }
}

/// `bytes` as text. They may have been cut off inside the last character.
fn words(bytes: &[u8]) -> Option<&str> {
    let whole = match str::from_utf8(bytes) {
        Err(error) if error.error_len().is_none() => &bytes[..error.valid_up_to()],
        _ => bytes,
    };
    str::from_utf8(whole).ok().map(str::trim).filter(|words| !words.is_empty())
}

/// The host and port, and the rate at the far end.
fn asked(target: &Target) -> Result<(String, Option<u32>), OpenError> {
    let address = target.address.clone().ok_or_else(|| OpenError::address_missing(target))?;
    let mut baud = None;
    read(target, "baud=RATE, that of the serial line at the far end", |key, value| {
        key == "baud" && set(&mut baud, positive(value).map(Some))
    })?;
    check_address(&address)?;
    Ok((address, baud))
}

/// Connects to the first of the host's addresses that answers.
fn connect(address: &str) -> Result<TcpStream, TcpError> {
    let mut failures = Vec::new();
    for number in resolve(address)? {
        match TcpStream::connect_timeout(&number, PATIENCE) {
            Ok(stream) => return Ok(stream),
            Err(error) => failures.push(error),
        }
    }
    Err(told_by(address.to_owned(), failures))
}

/// Why none of the addresses of the host of `address` could be connected to. Of several reasons the most telling one counts, since
/// addresses of a kind that this computer does not have fail too.
fn told_by(address: String, failures: Vec<io::Error>) -> TcpError {
    let source = failures.into_iter().min_by_key(|failure| match failure.kind() {
        io::ErrorKind::ConnectionRefused => 0,
        io::ErrorKind::TimedOut => 1,
        _ => 2,
    });
    let source = source.unwrap_or_else(|| io::ErrorKind::AddrNotAvailable.into());
    match source.kind() {
        io::ErrorKind::ConnectionRefused => TcpError::Refused(address),
        io::ErrorKind::TimedOut => TcpError::Silent { address, seconds: PATIENCE },
        _ => TcpError::Unreachable { address, source },
    }
}

fn check_address(address: &str) -> Result<(), TcpError> {
    let well_formed = address.rsplit_once(':').is_some_and(|(host, port)| {
        let bare = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
        let unambiguous = bare.is_some() || !host.contains(':');
        unambiguous && !bare.unwrap_or(host).is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0)
    });
    if well_formed { Ok(()) } else { Err(TcpError::Address(address.to_owned())) }
}

fn resolve(address: &str) -> Result<Vec<SocketAddr>, TcpError> {
    let asked = address.to_owned();
    let found = in_time(RESOLVED, move || asked.to_socket_addrs().map(Iterator::collect));
    found.map_err(|source| TcpError::UnknownHost { address: address.to_owned(), source })
}

/// What `ask` finds, which must not take longer than `patience`: while all name servers are silent, the system waits for as long as
/// its resolv.conf says, and nothing can stop it.
fn in_time<T: Send + 'static>(
    patience: Duration,
    ask: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> io::Result<T> {
    let (tell, told) = mpsc::channel();
    // Nobody may listen any more.
    thread::Builder::new().name("resolver".to_owned()).spawn(move || drop(tell.send(ask())))?;
    told.recv_timeout(patience).unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_server_that_says_nothing_is_not_waited_for() {
        let (hold, held) = mpsc::channel::<()>();
        let silent = move || held.recv().map_err(io::Error::other);
        let found = in_time(Duration::from_millis(1), silent).unwrap_err();
        assert_eq!(found.kind(), io::ErrorKind::TimedOut);
        drop(hold);
        assert_eq!(in_time(RESOLVED, || Ok(7)).unwrap(), 7);
    }

    /// As of a name with addresses of both kinds, on a computer without IPv6: those that cannot be used come last (RFC 6724, rule
    /// 1).
    #[test]
    fn of_several_addresses_the_most_telling_failure_counts() {
        use io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable, TimedOut};
        let told = |kinds: &[io::ErrorKind]| {
            told_by("bench:3001".to_owned(), kinds.iter().map(|&kind| kind.into()).collect())
        };
        assert!(matches!(told(&[ConnectionRefused, NetworkUnreachable]), TcpError::Refused(_)));
        assert!(matches!(told(&[TimedOut, ConnectionRefused]), TcpError::Refused(_)));
        assert!(matches!(told(&[ConnectionRefused, TimedOut]), TcpError::Refused(_)));
        assert!(matches!(told(&[TimedOut, NetworkUnreachable]), TcpError::Silent { .. }));
        let other = told(&[HostUnreachable, NetworkUnreachable]);
        assert!(matches!(other, TcpError::Unreachable { source, .. } if source.kind() == HostUnreachable));
        assert!(matches!(told(&[]), TcpError::Unreachable { .. }));
    }

    /// Whoever asks a run to stop may send no signal.
    #[test]
    fn a_silent_connection_is_not_waited_for_so_long_that_a_request_to_stop_goes_unnoticed() {
        const LONG: Duration = Duration::from_secs(60);
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let target = format!("tcp:{}", listener.local_addr().unwrap()).parse().unwrap();
        let mut link = TcpLink::open(&target).unwrap();
        let begun = Instant::now();
        assert_eq!(link.exchange(&[], &mut Vec::new(), LONG).unwrap(), 0);
        assert!(begun.elapsed() < LONG);
    }

    #[test]
    fn an_address_is_a_host_and_a_port() {
        assert_eq!(resolve("127.0.0.1:3001").unwrap(), ["127.0.0.1:3001".parse().unwrap()]);
        assert_eq!(resolve("[::1]:3001").unwrap(), ["[::1]:3001".parse().unwrap()]);
        for wrong in
            ["", "host", "host:", ":3001", "host:0", "host:http", "::1:3001", "[::1]", "[]:1", "host:70000"]
        {
            assert!(matches!(check_address(wrong), Err(TcpError::Address(_))), "{wrong}");
        }
    }
}
