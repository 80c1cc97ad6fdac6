//! Whom this computer trusts when it sends results over a network, and which addresses are on this computer.

mod certificate;

use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rustls::crypto::CryptoProvider;
use rustls::pki_types::CertificateDer;
use rustls::pki_types::pem::{self, PemObject as _};
use rustls::{ClientConfig, RootCertStore};

pub use certificate::CertificateError;

/// Why nobody can be trusted.
#[derive(Debug, thiserror::Error)]
pub enum TrustError {
    /// The file of trusted certificates cannot be read.
    #[error("the certificates in {} cannot be read; give a file of those that sign the other side's, in PEM", path.display())]
    Certificates {
        /// The file.
        path: PathBuf,
        /// Why.
        source: pem::Error,
    },
    /// There is no trusted certificate to check the other side by.
    #[error(
        "there is no certificate to know the other side by; give a file of those that sign its own as `ca`"
    )]
    NoCertificates,
    /// TLS cannot be used in this program.
    #[error("TLS cannot be used; report this with the version")]
    Tls(#[source] rustls::Error),
}

/// Whether what is sent to this host stays on this computer.
pub(crate) fn is_near(host: &str) -> bool {
    let address = host.trim_start_matches('[').trim_end_matches(']');
    host == "localhost" || address.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
}

/// The cryptography that TLS uses.
pub(crate) fn provider() -> Arc<CryptoProvider> {
    Arc::new(rustls::crypto::ring::default_provider())
}

/// The certificates in the file `ca`, or those of the system.
///
/// # Errors
/// [`TrustError`]
pub(crate) fn certificates(ca: Option<&Path>) -> Result<Vec<CertificateDer<'static>>, TrustError> {
    let found = match ca {
        Some(path) => {
            let refused = |source| TrustError::Certificates { path: path.to_owned(), source };
            let certificates = CertificateDer::pem_file_iter(path).map_err(refused)?;
            certificates.collect::<Result<_, _>>().map_err(refused)?
        }
        None => rustls_native_certs::load_native_certs().certs,
    };
    if found.is_empty() { Err(TrustError::NoCertificates) } else { Ok(found) }
}

/// A TLS client that trusts servers whose certificate is signed by one in the file `ca`, or by one of the system's own.
///
/// # Errors
/// [`TrustError`]
pub(crate) fn client(ca: Option<&Path>) -> Result<ClientConfig, TrustError> {
    let mut roots = RootCertStore::empty();
    for certificate in certificates(ca)? {
        match roots.add(certificate) {
            // It is nobody's fault if one of the system's own is not usable.
            Err(_) if ca.is_none() => {}
            added => added.map_err(TrustError::Tls)?,
        }
    }
    if roots.is_empty() {
        return Err(TrustError::NoCertificates);
    }
    let builder = ClientConfig::builder_with_provider(provider()).with_safe_default_protocol_versions();
    Ok(builder.map_err(TrustError::Tls)?.with_root_certificates(roots).with_no_client_auth())
}
