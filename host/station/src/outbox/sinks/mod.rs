//! Sinks that are not a plant: a folder, a web server, a broker of events.

mod events;
mod folder;
mod letter;
mod post;

use std::io;
use std::path::PathBuf;

use halfrow::files::written_aside::WriteAsideError;

use super::{Sink, Undelivered};
use crate::export::ExportError;
use crate::said::Said;
use crate::secret::SecretError;
use crate::settings::{Destination, SinkSettings};
use crate::trust::{CertificateError, TrustError};

/// A sink that cannot be used as the settings say.
#[derive(Debug, thiserror::Error)]
pub enum SinkSettingsError {
    /// Its password or token.
    #[error(transparent)]
    Secret(#[from] SecretError),
    /// The sink's token has characters that cannot be sent in a request.
    #[error("{} holds no token; write it alone into one line, of letters, digits and signs of ASCII", path.display())]
    Token {
        /// The file.
        path: PathBuf,
    },
    /// Nobody can be trusted.
    #[error(transparent)]
    Trust(#[from] TrustError),
}

/// Why a sink has not taken something.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SinkError {
    /// The sink's folder does not exist.
    #[error("the folder {} is not there; make it, or mount what it lies on", path.display())]
    NoFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The sink's folder cannot be reached; whether it is there is not known.
    #[error(
        "the folder {} cannot be reached; open it and what it lies in to the station's user, and take none below /home, which is \
         closed to the service (ProtectHome=)", path.display()
    )]
    Shut {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The station may not write into the sink's folder.
    #[error(
        "the folder {0} is read-only to the station; mount it writable, or let the service write to it: `systemctl edit \
         halfrow-station`, with ReadWritePaths={0} below [Service]", path.display()
    )]
    ReadOnly {
        /// The folder.
        path: PathBuf,
        /// The file that was not written.
        source: WriteAsideError,
    },
    /// The sink's folder has a file of this name with other bytes.
    #[error(
        "{} is there already with other bytes; nothing was changed: keep both, and find out which is right",
        path.display()
    )]
    OtherFile {
        /// The file.
        path: PathBuf,
    },
    /// The file could not be written to the sink's folder.
    #[error(transparent)]
    Unwritten(#[from] WriteAsideError),
    /// A file in the sink's folder could not be read.
    #[error("{} cannot be read; check who may", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The run cannot be made into what the sink wants.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The sink's server cannot be reached.
    #[error("{host} is not reached; look at the network and the other side")]
    Unreached {
        /// The other side.
        host: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The server's certificate does not show that it is the one that the settings name.
    #[error(transparent)]
    Certificate(#[from] CertificateError),
    /// The sink's server cannot take the entry for now.
    #[error("{host} answers {status}; it is asked again later")]
    Busy {
        /// The other side.
        host: String,
        /// Its answer's number.
        status: u16,
    },
    /// The sink's server refuses everything the station sends to this address: the token or the address is wrong.
    #[error("{host} answers {status} to everything; check the address and the token in the settings")]
    Closed {
        /// The other side.
        host: String,
        /// Its answer's number.
        status: u16,
    },
    /// The broker refuses the station's user name or password.
    #[error("{host} does not let the station in ({said}); check user and password_file in the settings")]
    Unknown {
        /// The other side.
        host: String,
        /// What it says.
        said: String,
    },
    /// The sink's server refuses this one entry, but takes others.
    #[error("{host} answers {status} to this ({answer}); correct there what it complains of, and release it")]
    Rejected {
        /// The other side.
        host: String,
        /// Its answer's number.
        status: u16,
        /// What it says.
        answer: String,
    },
    /// The broker let the station in, and ended the connection when it was given this event.
    #[error(
        "{host} ended the connection over an event of {bytes} bytes; if it takes others, look at how long a message may be there"
    )]
    Dropped {
        /// The other side.
        host: String,
        /// How long the event is.
        bytes: usize,
        /// How the connection ended.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The broker did not confirm an event in time.
    #[error("{host} has not confirmed an event within {seconds} s; look at the broker")]
    Unconfirmed {
        /// The other side.
        host: String,
        /// How long it was waited for.
        seconds: u64,
    },
}

impl SinkError {
    /// The error when no connection to `host` was established.
    fn unconnected(host: &str, source: Box<dyn std::error::Error + Send + Sync>) -> Self {
        match CertificateError::of(host, &*source) {
            Some(error) => error.into(),
            None => Self::Unreached { host: host.to_owned(), source },
        }
    }
}

impl From<SinkError> for Undelivered {
    fn from(error: SinkError) -> Self {
        let said = Said::of(&error);
        match error {
            SinkError::NoFolder { .. }
            | SinkError::Shut { .. }
            | SinkError::ReadOnly { .. }
            | SinkError::Unreached { .. }
            | SinkError::Certificate(_)
            | SinkError::Closed { .. }
            | SinkError::Unknown { .. }
            | SinkError::Unconfirmed { .. } => Self::Away(said),
            SinkError::Busy { status: 409 | 500, .. }
            | SinkError::Dropped { .. }
            | SinkError::Unwritten(_)
            | SinkError::Unread { .. }
            | SinkError::Export(_) => Self::NotNow(said),
            SinkError::Busy { .. } => Self::Away(said),
            SinkError::OtherFile { .. } | SinkError::Rejected { .. } => Self::Refused(said),
        }
    }
}

/// The sink of these settings, for the station `station`.
///
/// # Errors
/// [`SinkSettingsError`]
pub fn open(settings: &SinkSettings, station: &str) -> Result<Box<dyn Sink>, SinkSettingsError> {
    let name = settings.name.clone();
    Ok(match &settings.to {
        Destination::Folder { path, format } => {
            Box::new(folder::FolderSink { name, folder: path.clone(), format: *format, is_clear: false })
        }
        Destination::Post { address, format, token, proxy } => {
            Box::new(post::PostSink::new(name, address, *format, token.as_deref(), proxy.as_ref())?)
        }
        Destination::Events { address, login } => {
            Box::new(events::EventSink::new(name, station, address, login.as_ref())?)
        }
    })
}
