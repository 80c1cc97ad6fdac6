//! From a target string to a link.

use std::path::{Path, PathBuf};

use halfrow_mock::{Wire, WireError};

#[cfg(feature = "sim")]
use super::simulated::open_simulated;
use super::{
    Candidate, Link, Recording, RecordingError, ReplayLink, SerialError, SerialLink, TcpError, TcpLink,
    UsbError, UsbLink, WireLink,
};
use crate::Class;
use crate::target::{BoardKind, Target};

const MOCK: &str = "the mock board";

/// A target that leads nowhere.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The kind is not known.
    #[error(
        "`{0}` is no kind of board that this program knows; it knows mock, sim, sim:uart, sim:fifo, serial:PATH, \
         usb, usb:SERIAL, tcp:HOST:PORT and replay:FILE"
    )]
    UnknownKind(String),
    /// A kind that has no address.
    #[error("`{kind}` takes no address, and got `{address}`; write `{kind}` alone, options behind a comma")]
    NoAddress {
        /// The kind.
        kind: String,
        /// The address.
        address: String,
    },
    /// A kind that needs an address.
    #[error("`{kind}` needs to be told which; write {form}")]
    AddressMissing {
        /// The kind.
        kind: String,
        /// How such a target is written.
        form: &'static str,
    },
    /// An option that the kind does not have, or not with this value.
    #[error("`{option}` is no option of `{kind}`; it takes {known}")]
    Option {
        /// The kind.
        kind: String,
        /// The option.
        option: String,
        /// The options that there are.
        known: &'static str,
    },
    /// A kind that has no options.
    #[error("`{kind}` takes no option, and got `{option}`; leave it out")]
    NoOption {
        /// The kind.
        kind: String,
        /// The option.
        option: String,
    },
    /// The board does not take these options.
    #[error("the target `{target}` is not one that {board} takes")]
    Options {
        /// Which board.
        board: &'static str,
        /// The target.
        target: String,
        /// Why.
        #[source]
        source: Box<WireError>,
    },
    /// An option whose value is none.
    #[error("`{key}={value}` is not an option of this board; write {key}=virtual or {key}=real")]
    Pace {
        /// The key.
        key: String,
        /// Its value.
        value: String,
    },
    /// A simulation behind another front end than there is.
    #[error("`sim:{0}` is no simulated board; write sim, sim:uart or sim:fifo")]
    UnknownFront(String),
    /// This program was built without the simulation.
    #[error(
        "this program was built without the simulated board, which needs Verilator; for `{0}`, install it with \
         `apt-get install verilator g++`, and build with Cargo's feature `sim`"
    )]
    NoSimulation(String),
    /// The waveform cannot be written.
    #[cfg(feature = "sim")]
    #[error(transparent)]
    Trace(#[from] halfrow_sim::TraceError),
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
    /// Whose error it is.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::Serial(error) => error.class(),
            Self::Tcp(error) => error.class(),
            Self::Usb(error) => error.class(),
            _ => Class::Call,
        }
    }
}

/// The file of a `replay:FILE` target.
#[must_use]
pub fn replayed_file(target: &Target) -> Option<PathBuf> {
    target.address.as_ref().filter(|_| target.kind == "replay").map(PathBuf::from)
}

/// Opens the link that `target` names; nothing is said over it yet.
///
/// # Errors
/// [`OpenError`] when the target is none of ours, or its options are not.
pub fn open(target: &Target) -> Result<Candidate, OpenError> {
    let (kind, link): (_, Box<dyn Link>) = match target.kind.as_str() {
        "mock" => (BoardKind::Mock, open_mock(target)?),
        "sim" => (BoardKind::Sim, open_simulated(target)?),
        "serial" => (BoardKind::Hardware, Box::new(SerialLink::open(target)?)),
        "usb" => (BoardKind::Hardware, Box::new(UsbLink::open(target)?)),
        "tcp" => (BoardKind::Hardware, Box::new(TcpLink::open(target)?)),
        "replay" => (BoardKind::Replay, open_replay(target)?),
        other => return Err(OpenError::UnknownKind(other.to_owned())),
    };
    let again = target.clone();
    let reopen = Box::new(move || Ok(open(&again)?.link));
    Ok(Candidate { target: target.to_string(), kind, link, reopen: Some(reopen) })
}

fn open_mock(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    if let Some(address) = &target.address {
        return Err(OpenError::NoAddress { kind: target.kind.clone(), address: address.clone() });
    }
    let (paced, options) = pace(target)?;
    let wire = Wire::from_options(&options).map_err(|source| wrong_options(MOCK, target, source))?;
    Ok(Box::new(WireLink::new(wire, MOCK, paced)))
}

#[cfg(not(feature = "sim"))]
fn open_simulated(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    Err(OpenError::NoSimulation(target.to_string()))
}

/// Options of a target, each with its value.
pub(super) type Options<'a> = Vec<(&'a str, &'a str)>;

/// Whether the wire of a board in this process is paced, and the other options.
pub(super) fn pace(target: &Target) -> Result<(bool, Options<'_>), OpenError> {
    let mut paced = false;
    let mut options = Options::new();
    for (key, value) in &target.options {
        match (key.as_str(), value.as_str()) {
            ("pace", "real") => paced = true,
            ("pace", "virtual") => paced = false,
            ("pace", _) => return Err(OpenError::Pace { key: key.clone(), value: value.clone() }),
            option => options.push(option),
        }
    }
    Ok((paced, options))
}

pub(super) fn wrong_options(board: &'static str, target: &Target, source: WireError) -> OpenError {
    OpenError::Options { board, target: target.to_string(), source: Box::new(source) }
}

fn open_replay(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    if let Some((key, value)) = target.options.first() {
        return Err(OpenError::NoOption { kind: target.kind.clone(), option: format!("{key}={value}") });
    }
    let file = target
        .address
        .as_deref()
        .ok_or_else(|| OpenError::AddressMissing { kind: target.kind.clone(), form: "replay:FILE" })?;
    Ok(Box::new(ReplayLink::new(Recording::read(Path::new(file))?)?))
}
