//! Where the pages are: the address that is listened on, and the names under which browsers may ask for it.

use std::net::SocketAddr;

/// An address of the pages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    pub(super) listen: SocketAddr,
    /// What stands before `//` in the address that browsers show.
    is_https: bool,
    /// Every value that the header `Host` may have.
    hosts: Vec<String>,
}

/// An address that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AddressError {
    /// It is no address.
    #[error("`{0}` is no address to listen on; write one as 127.0.0.1:8612")]
    Listen(String),
    /// It is no origin.
    #[error(
        "`{0}` is not where browsers find a station; write it as https://station12.example, without a path"
    )]
    Public(String),
}

impl Address {
    /// The address `listen`, under its own name, that of `public`, and the names `hosts`.
    ///
    /// # Errors
    /// [`AddressError`]
    pub fn new(listen: &str, public: Option<&str>, hosts: &[String]) -> Result<Self, AddressError> {
        let listen: SocketAddr = listen.parse().map_err(|_| AddressError::Listen(listen.to_owned()))?;
        let mut all = hosts.to_vec();
        let mut is_https = false;
        if let Some(public) = public {
            let refused = || AddressError::Public(public.to_owned());
            let (scheme, host) = public.split_once("://").ok_or_else(refused)?;
            let is_host = |byte: u8| byte.is_ascii_alphanumeric() || b".-:[]".contains(&byte);
            if !["http", "https"].contains(&scheme) || host.is_empty() || !host.bytes().all(is_host) {
                return Err(refused());
            }
            is_https = scheme == "https";
            all.push(host.to_owned());
        }
        let address = Self { listen, is_https, hosts: all };
        Ok(address.at(listen.port()))
    }

    /// This address with the port that the system gave for port 0.
    pub(crate) fn at(mut self, port: u16) -> Self {
        self.listen.set_port(port);
        if self.listen.ip().is_loopback() {
            self.hosts.extend(["localhost", "127.0.0.1", "[::1]"].map(|name| format!("{name}:{port}")));
        } else if !self.listen.ip().is_unspecified() {
            self.hosts.push(self.listen.to_string());
        }
        self
    }

    /// Whether nobody outside this computer gets here.
    #[must_use]
    pub fn is_private(&self) -> bool {
        self.listen.ip().is_loopback() && !self.is_https
    }

    /// Whether what browsers send goes through TLS.
    pub(crate) fn is_https(&self) -> bool {
        self.is_https
    }

    /// Whether a request for this `Host` is for the station. A page of somebody else whose name was made to lead here is
    /// not.
    pub(crate) fn is_host(&self, host: &str) -> bool {
        self.hosts.iter().any(|known| known.eq_ignore_ascii_case(host))
    }

    /// Whether a page of this `Origin` is the station's own, when it is asked for as `host`.
    pub(crate) fn is_origin(&self, origin: &str, host: &str) -> bool {
        let scheme = if self.is_https { "https" } else { "http" };
        origin
            .strip_prefix(scheme)
            .and_then(|rest| rest.strip_prefix("://"))
            .is_some_and(|rest| rest.eq_ignore_ascii_case(host))
    }
}
