//! Why a target leads to no board.

use std::error::Error;

use halfrow_pipe::meant;

use crate::kinds::{self, KINDS, Kind};
use crate::{Class, RecordingError, SerialError, Target, TcpError, TraceError, UsbError};

/// A target that leads nowhere.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The target begins with a kind of board that this program does not know.
    #[error("`{kind}` is not a known kind of board{like}; {remedy}", like = like(.kind), remedy = instead_of(.kind, .known))]
    UnknownKind {
        /// The kind.
        kind: String,
        /// How the targets that the caller takes are written, with commas between.
        known: String,
    },
    /// The target has an address, but boards of this kind have none.
    #[error(
        "`{kind}` takes no address, but got `{address}`; write `{kind}` alone, with options after a comma"
    )]
    NoAddress {
        /// The kind.
        kind: String,
        /// The address.
        address: String,
    },
    /// The target lacks the address that boards of this kind need.
    #[error("`{kind}` needs an address; write {form}")]
    AddressMissing {
        /// The kind.
        kind: String,
        /// How such a target is written.
        form: String,
    },
    /// The target has an option that boards of this kind do not have, or not with this value.
    #[error("`{option}` is not an option of `{kind}`; it takes {known}")]
    Option {
        /// The kind.
        kind: String,
        /// The option.
        option: String,
        /// The options that there are.
        known: &'static str,
    },
    /// An option of the target contradicts the board that another option names.
    #[error("`{option}` contradicts `board={board}`, which means {meaning}; leave one of the two out")]
    OtherBoard {
        /// The option.
        option: String,
        /// The board.
        board: &'static str,
        /// The options that the board stands for.
        meaning: String,
    },
    /// The board does not take the options in the target.
    #[error("the target `{target}` does not suit {board}")]
    Options {
        /// Which board.
        board: &'static str,
        /// The target.
        target: String,
        /// Why.
        #[source]
        source: Box<dyn Error + Send + Sync>,
    },
    /// The option for the target's clock has a value other than `virtual` and `real`.
    #[error("`{key}={value}` is not an option of this board; write {key}=virtual or {key}=real")]
    Pace {
        /// The key.
        key: String,
        /// Its value.
        value: String,
    },
    /// The simulated board has no front end of this name.
    #[error("`sim:{0}` is no simulated board; write sim, sim:uart or sim:fifo")]
    UnknownFront(String),
    /// This program was built without the simulated board.
    #[error(
        "this program was built without the simulated board, which needs Verilator; for `{0}`, install it with \
         `apt-get install verilator g++`, and build with Cargo's feature `sim`"
    )]
    NoSimulation(String),
    /// The waveform cannot be written; only with Cargo's feature `sim`.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The system does not let the board's device or connection be used, or not in the way that a link needs.
    #[error("the system does not let `{target}` be used; check that it is there and that you may use it")]
    System {
        /// The target.
        target: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The serial port cannot be opened.
    #[error(transparent)]
    Serial(#[from] SerialError),
    /// There is no connection.
    #[error(transparent)]
    Tcp(#[from] TcpError),
    /// The USB device cannot be opened.
    #[error(transparent)]
    Usb(#[from] UsbError),
    /// The recording cannot be played.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl OpenError {
    /// The target's kind needs an address, and got none.
    pub(crate) fn address_missing(target: &Target) -> Self {
        let kind = target.kind.clone();
        let forms = kinds::of(target).map(Kind::targets).unwrap_or_default();
        Self::AddressMissing { form: forms.join(" or "), kind }
    }

    /// Whether the target's device exists but this program cannot use it, because of permissions, another program, or how it is
    /// set up.
    #[must_use]
    pub fn is_kept_from_us(&self) -> bool {
        match self {
            Self::Serial(error) => {
                matches!(
                    error,
                    SerialError::NotAllowed { .. } | SerialError::NotGiven(_) | SerialError::InUse { .. }
                )
            }
            Self::Usb(error) => matches!(
                error,
                UsbError::NotPermitted { .. }
                    | UsbError::NotGiven { .. }
                    | UsbError::Busy { .. }
                    | UsbError::OtherMode { .. }
                    | UsbError::UnusableMode { .. }
                    | UsbError::NoMode { .. }
            ),
            _ => false,
        }
    }

    /// Who can do something about it.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::Serial(error) => error.class(),
            Self::Tcp(error) => error.class(),
            Self::Usb(error) => error.class(),
            Self::System { .. } => Class::Station,
            Self::UnknownKind { .. }
            | Self::NoAddress { .. }
            | Self::AddressMissing { .. }
            | Self::Option { .. }
            | Self::OtherBoard { .. }
            | Self::Options { .. }
            | Self::Pace { .. }
            | Self::UnknownFront(_)
            | Self::NoSimulation(_)
            | Self::Trace(_)
            | Self::Recording(_) => Class::Call,
        }
    }
}

/// What to write instead of an unknown kind. A device's path ends up as the kind when no kind stands before it.
fn instead_of(kind: &str, known: &str) -> String {
    if kind.starts_with("/dev/") {
        return format!("for a serial port write serial:{kind}");
    }
    if kind.starts_with("tty") {
        return format!("for a serial port write serial:/dev/{kind}");
    }
    if kind == "pool" {
        return "a board of a pool cannot be named here, so name the board itself".to_owned();
    }
    format!("choose from {known}")
}

/// The known kind that an unknown one is like, as [`meant`] tells it.
fn like(kind: &str) -> String {
    let names: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
    meant(kind, &names.join(", "))
}
