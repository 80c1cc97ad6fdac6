//! Where a plant is, who asks, and whether what is sent goes through TLS.

use std::fmt;
use std::net::IpAddr;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use rustls::ClientConfig;
use tokio_postgres::config::{Host, SslMode};
use tokio_postgres::{Config, NoTls};
use tokio_postgres_rustls::MakeRustlsConnect;

use super::super::database::{DatabaseError, Postgres};
use crate::trust::{self, TrustError};

/// How long a connection may take to be established.
const REACHED: Duration = Duration::from_secs(10);
/// How long to wait for a server's answer. Ordinary questions take it a few seconds at most.
const SILENT: Duration = Duration::from_secs(20);
/// The same for a question that is soon asked again, and for being connected then. Such questions take a server an instant.
const HASTY: Duration = Duration::from_secs(4);
/// How long what was sent to a server may stay without a TCP acknowledgement.
const ACKNOWLEDGED: Duration = Duration::from_secs(20);
/// How long a connection may be idle before a TCP keepalive probe, and the time between two probes.
const QUIET: Duration = Duration::from_secs(10);

/// An address of a plant that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PlantAddressError {
    /// The text is not the address of a plant.
    #[error("this is no address of a plant; write it as postgres://station@db.example/plant")]
    Malformed(#[source] tokio_postgres::Error),
    /// The plant's address lacks the host, the user or the database.
    #[error("the plant's address says no {what}; write it as postgres://station@db.example/plant")]
    Without {
        /// What it does not say.
        what: &'static str,
    },
    /// The plant's address contains a password, which anybody could see.
    #[error(
        "the plant's address has a password, which anybody may see who sees these settings; write it alone into a file, and its \
         name as password_file"
    )]
    Password,
    /// Nobody can be trusted.
    #[error(transparent)]
    Trust(#[from] TrustError),
}

/// Where a plant is. It is printed without its password.
#[derive(Clone)]
pub struct PlantAddress {
    config: Config,
    tls: Option<Arc<ClientConfig>>,
    shown: String,
    patience: Option<Duration>,
}

impl PlantAddress {
    /// The address `url`, with `password` if the plant asks for one. Whatever leaves this computer goes through TLS, and the
    /// plant's certificate must be signed by one in the file `ca`, or by one of the system's own.
    ///
    /// # Errors
    /// [`PlantAddressError`]
    pub fn new(url: &str, password: Option<&str>, ca: Option<&Path>) -> Result<Self, PlantAddressError> {
        let mut config: Config = url.parse().map_err(PlantAddressError::Malformed)?;
        if config.get_password().is_some() {
            return Err(PlantAddressError::Password);
        }
        let shown = shown(&config)?;
        let is_near =
            config.get_hosts().iter().all(is_near) && config.get_hostaddrs().iter().all(IpAddr::is_loopback);
        let tls = if is_near && config.get_ssl_mode() != SslMode::Require {
            config.ssl_mode(SslMode::Disable);
            None
        } else {
            config.ssl_mode(SslMode::Require);
            Some(Arc::new(trust::client(ca)?))
        };
        if let Some(password) = password {
            config.password(password);
        }
        config
            .application_name("halfrow-station")
            .connect_timeout(REACHED)
            .tcp_user_timeout(ACKNOWLEDGED)
            .keepalives_idle(QUIET)
            .keepalives_interval(QUIET)
            .keepalives_retries(2);
        Ok(Self { config, tls, shown, patience: Some(SILENT) })
    }

    /// The same without a time limit on answers, for long questions of a person who sees that there is no answer yet.
    #[must_use]
    pub(crate) fn patient(&self) -> Self {
        Self { patience: None, ..self.clone() }
    }

    /// The same for a question that has to be answered in time, if need be over the next connection: one to a server that is gone
    /// stays silent for ever.
    #[must_use]
    pub(super) fn hasty(&self) -> Self {
        let mut hasty = Self { patience: Some(HASTY), ..self.clone() };
        // It holds for each address of a name, of which the first may be gone.
        hasty.config.connect_timeout(HASTY / 2).tcp_user_timeout(HASTY);
        hasty
    }

    /// A new connection.
    pub(super) fn connect(&self) -> Result<Postgres, DatabaseError> {
        let servers = self.config.get_hosts().len().max(self.config.get_hostaddrs().len());
        let reached =
            self.patience.unwrap_or(SILENT).saturating_mul(u32::try_from(servers).unwrap_or(u32::MAX));
        match &self.tls {
            None => Postgres::connect(&self.config, NoTls, reached, self.patience),
            Some(tls) => {
                let tls = MakeRustlsConnect::new(ClientConfig::clone(tls));
                Postgres::connect(&self.config, tls, reached, self.patience)
            }
        }
    }
}

impl fmt::Display for PlantAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.shown)
    }
}

impl fmt::Debug for PlantAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("PlantAddress").field(&self.shown).finish()
    }
}

/// The address without anything secret.
fn shown(config: &Config) -> Result<String, PlantAddressError> {
    let without = |what| PlantAddressError::Without { what };
    let host = match config.get_hosts().first().ok_or(without("host"))? {
        Host::Tcp(name) => name.clone(),
        Host::Unix(path) => path.display().to_string(),
    };
    let user = config.get_user().ok_or(without("user"))?;
    let name = config.get_dbname().ok_or(without("database"))?;
    let port = config.get_ports().first().map(|port| format!(":{port}")).unwrap_or_default();
    Ok(format!("postgres://{user}@{host}{port}/{name}"))
}

/// Whether what is sent to this host stays on this computer.
fn is_near(host: &Host) -> bool {
    match host {
        Host::Unix(_) => true,
        Host::Tcp(name) => trust::is_near(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The name of the server may have two addresses, of which the first is gone.
    #[test]
    fn a_hasty_connection_has_time_for_a_second_address() {
        let address = PlantAddress::new("postgres://halfrow@db.example/plant", None, None).unwrap();
        let ordinary = address.config.get_connect_timeout().unwrap();
        assert!(2 * *ordinary <= address.patience.unwrap(), "the control");
        let hasty = address.hasty();
        assert!(2 * *hasty.config.get_connect_timeout().unwrap() <= hasty.patience.unwrap());
    }
}
