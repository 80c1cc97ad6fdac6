//! What is wrong with a certificate because of which the other side was not trusted.

use std::error::Error;
use std::io;

use rustls::CertificateError as Invalid;
use rustls::pki_types::UnixTime;

use crate::clock;

/// The other side's certificate is not good. Moments are in the station's local time.
#[derive(Debug, thiserror::Error)]
pub enum CertificateError {
    /// By this computer's clock, the other side's certificate has expired.
    #[error(
        "the certificate of {host} was valid until {until}, and this computer's clock says {now}; renew it there, or set the clock if it \
         is wrong"
    )]
    Expired {
        /// The other side.
        host: String,
        /// The last moment at which it was good.
        until: String,
        /// This moment.
        now: String,
    },
    /// By this computer's clock, the other side's certificate is not valid yet.
    #[error(
        "the certificate of {host} is valid from {from} on, and this computer's clock says {now}; set the clock, or wait until then if it \
         is right"
    )]
    NotYet {
        /// The other side.
        host: String,
        /// The first moment at which it is good.
        from: String,
        /// This moment.
        now: String,
    },
    /// The other side's certificate is for other names than the one in the address.
    #[error(
        "the certificate of {host} is of another name ({names}); give the address by a name that it has, or have it made for this one"
    )]
    OtherName {
        /// The other side.
        host: String,
        /// The names that it has.
        names: String,
    },
    /// The other side's certificate is signed by none of those in `ca`, or of the system's own where the settings name no
    /// file.
    #[error(
        "the certificate of {host} is signed by nobody who is trusted; give a file of those that sign it as `ca`"
    )]
    Stranger {
        /// The other side.
        host: String,
    },
    /// The other side's certificate was refused for a reason that the cause tells.
    #[error("the certificate of {host} is not good for this; have another one made there")]
    Unfit {
        /// The other side.
        host: String,
        /// Why.
        source: rustls::Error,
    },
}

impl CertificateError {
    /// What is wrong with the certificate of `host`, if `error` is about that.
    pub(crate) fn of(host: &str, error: &(dyn Error + 'static)) -> Option<Self> {
        let mut next = Some(error);
        while let Some(error) = next {
            if let Some(rustls::Error::InvalidCertificate(invalid)) = error.downcast_ref() {
                return Some(Self::by(host, invalid));
            }
            next = within(error);
        }
        None
    }

    fn by(host: &str, invalid: &Invalid) -> Self {
        let host = host.to_owned();
        match invalid {
            Invalid::ExpiredContext { time, not_after } => {
                Self::Expired { host, until: moment(*not_after), now: moment(*time) }
            }
            Invalid::NotValidYetContext { time, not_before } => {
                Self::NotYet { host, from: moment(*not_before), now: moment(*time) }
            }
            Invalid::NotValidForNameContext { presented, .. } => Self::OtherName {
                host,
                names: presented.iter().map(|name| bare(name)).collect::<Vec<_>>().join(", "),
            },
            // A bad signature means that a signer of the same name has another key.
            Invalid::UnknownIssuer | Invalid::BadSignature => Self::Stranger { host },
            invalid => Self::Unfit { host, source: rustls::Error::InvalidCertificate(invalid.clone()) },
        }
    }
}

/// The cause of an error; some errors have it elsewhere than in their source.
fn within<'a>(error: &'a (dyn Error + 'static)) -> Option<&'a (dyn Error + 'static)> {
    if let Some(error) = error.downcast_ref::<io::Error>() {
        return error.get_ref().map(|error| error as _);
    }
    match error.downcast_ref() {
        Some(ureq::Error::Io(error)) => Some(error),
        Some(ureq::Error::Rustls(error)) => Some(error),
        _ => error.source(),
    }
}

fn moment(time: UnixTime) -> String {
    let ms = i64::try_from(time.as_secs()).unwrap_or(i64::MAX).saturating_mul(1000);
    clock::local(ms).strftime("%Y-%m-%d %H:%M %:z").to_string()
}

/// A name of a certificate without its kind: of `DnsName("mes.example")` the text in quotes.
fn bare(name: &str) -> String {
    let bare = name.split_once('(').and_then(|(_, rest)| rest.strip_suffix(')'));
    bare.unwrap_or(name).trim_matches('"').to_owned()
}
