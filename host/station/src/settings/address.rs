//! Where the pages are: the address to listen on, and the names under which browsers may ask for it.

use std::net::SocketAddr;

use crate::trust::is_near;

/// An address of the pages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    pub(crate) listen: SocketAddr,
    /// Whether the address that browsers show begins with `https:`.
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
    /// It is no name.
    #[error(
        "`{0}` is no name by which browsers ask for a station; write it as station12:8612, without http:// and without a path"
    )]
    Host(String),
}

impl Address {
    /// The address `listen`, under its own name, that of `public`, and the names `hosts`.
    ///
    /// # Errors
    /// [`AddressError`]
    pub fn new(listen: &str, public: Option<&str>, hosts: &[String]) -> Result<Self, AddressError> {
        let listen: SocketAddr = listen.parse().map_err(|_| AddressError::Listen(listen.to_owned()))?;
        if let Some(wrong) = hosts.iter().find(|host| !may_be_host(host)) {
            return Err(AddressError::Host(wrong.clone()));
        }
        let mut all = hosts.to_vec();
        let mut is_https = false;
        if let Some(public) = public {
            let refused = || AddressError::Public(public.to_owned());
            let (scheme, host) = public.split_once("://").ok_or_else(refused)?;
            if !["http", "https"].contains(&scheme) || !may_be_host(host) {
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
        // A browser leaves out the port of its scheme (URL standard, section 4.4).
        let default = if self.is_https { ":443" } else { ":80" };
        let short = |host: &String| host.strip_suffix(default).map(str::to_owned);
        self.hosts.extend(self.hosts.iter().filter_map(short).collect::<Vec<_>>());
        self
    }

    /// Whether nobody outside this computer gets here. A name that is not this computer's is a proxy's, through which others
    /// come.
    #[must_use]
    pub(crate) fn is_private(&self) -> bool {
        let is_here = |host: &String| is_near(without_port(host));
        self.listen.ip().is_loopback() && !self.is_https && self.hosts.iter().all(is_here)
    }

    /// Whether others may come through a proxy on this computer: to a loopback address they come only so, and with TLS the proxy
    /// that speaks it may be on this computer.
    pub(crate) fn may_have_proxy_here(&self) -> bool {
        !self.is_private() && (self.listen.ip().is_loopback() || self.is_https)
    }

    /// Whether no name is known under which browsers could ask for it.
    pub(crate) fn is_nameless(&self) -> bool {
        self.hosts.is_empty()
    }

    /// Whether what browsers send goes through TLS.
    pub(crate) fn is_https(&self) -> bool {
        self.is_https
    }

    /// Whether a request for this `Host` is for the station. A request of a foreign page whose name was made to resolve to
    /// this address (DNS rebinding) is not.
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

/// Whether a header `Host` may have this value.
fn may_be_host(host: &str) -> bool {
    let is_of_host = |byte: u8| byte.is_ascii_alphanumeric() || b".-_:[]".contains(&byte);
    !host.is_empty() && host.bytes().all(is_of_host)
}

/// The name or address in a value of the header `Host`.
fn without_port(host: &str) -> &str {
    // An address of IPv6 has its colons between brackets.
    let is_whole = |name: &str| name.ends_with(']') || !name.contains(':');
    let is_port = |port: &str| port.bytes().all(|digit| digit.is_ascii_digit());
    let parted = host.rsplit_once(':').filter(|(name, port)| is_whole(name) && is_port(port));
    parted.map_or(host, |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_browser_that_leaves_out_the_port_of_its_scheme_is_at_the_right_station() {
        let is_host = |listen: &str, public: Option<&str>, host: &str| {
            Address::new(listen, public, &["a:80".to_owned()]).unwrap().is_host(host)
        };
        for (listen, public, host) in [
            ("10.0.0.12:80", None, "10.0.0.12"),
            ("127.0.0.1:80", None, "localhost"),
            ("[fd00::1]:80", None, "[fd00::1]"),
            ("127.0.0.1:8612", None, "a"),
            ("127.0.0.1:8612", Some("https://x:443"), "x"),
            ("127.0.0.1:8612", Some("http://x:80"), "x"),
        ] {
            assert!(is_host(listen, public, host), "{host} at {listen} as {public:?}");
        }
        for (public, host) in [("https://x:80", "x"), ("http://x:443", "x"), ("http://x", "127.0.0.1")] {
            assert!(!is_host("127.0.0.1:8612", Some(public), host), "{host} as {public}");
        }
    }

    #[test]
    fn only_names_of_this_computer_are_private() {
        let is_private = |listen: &str, public: Option<&str>, host: &str| {
            let hosts = [host.to_owned()].into_iter().filter(|host| !host.is_empty());
            Address::new(listen, public, &hosts.collect::<Vec<_>>()).unwrap().is_private()
        };
        let here = "127.0.0.1:8612";
        for near in ["", "localhost", "localhost:80", "127.0.0.2:80", "[::1]:80", "[::1]"] {
            assert!(is_private(here, None, near), "{near}");
        }
        for far in ["station12", "station12:8612", "10.0.0.12", "localhost.example:80", "::1:80"] {
            assert!(!is_private(here, None, far), "{far}");
        }
        assert!(is_private("[::1]:8612", Some("http://localhost:80"), ""));
        assert!(!is_private(here, Some("http://station12"), ""));
        assert!(!is_private(here, Some("https://station12.example"), ""));
        assert!(!is_private("10.0.0.12:8612", None, ""));
    }
}
