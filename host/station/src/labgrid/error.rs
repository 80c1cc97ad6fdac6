//! Why a place cannot be acquired.

use std::io;

use serde::Deserialize;

/// Why the lane does not get a board from labgrid.
#[derive(Debug, thiserror::Error)]
pub enum LabgridError {
    /// The program that reaches labgrid could not be started.
    #[error(
        "{program}, which reaches labgrid, cannot be started; install the Python package halfrow-labgrid, and name its program in \
         [labgrid]"
    )]
    NotStarted {
        /// The program.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// The program that reaches labgrid ended without an answer.
    #[error("{program}, which reaches labgrid, ended without an answer: {said}; start it by hand to see why")]
    Failed {
        /// The program.
        program: String,
        /// The last line that it wrote to stderr.
        said: String,
    },
    /// labgrid gave no answer in time.
    #[error(
        "labgrid gave no answer about the place {place} within {seconds} s; look at its coordinator and the place's exporter"
    )]
    Late {
        /// The place.
        place: String,
        /// How long the answer was waited for.
        seconds: f64,
    },
    /// labgrid's coordinator does not answer.
    #[error(
        "labgrid's coordinator {coordinator} does not answer; start it, or write `coordinator` in [labgrid] or the variable LG_COORDINATOR"
    )]
    CoordinatorAway {
        /// Host and port.
        coordinator: String,
    },
    /// labgrid has no such place.
    #[error("labgrid knows no place {place}; write one of: {known}")]
    Unknown {
        /// The place.
        place: String,
        /// Those that it knows.
        known: String,
    },
    /// Another user has acquired labgrid's place.
    #[error("{holder} has labgrid's place {place}; wait until it is released, or ask them for it")]
    Held {
        /// The place.
        place: String,
        /// Computer and user, as labgrid shows them.
        holder: String,
    },
    /// labgrid's coordinator refused to let the place be acquired.
    #[error("labgrid does not give the place {place}: {said}; see `labgrid-client -p {place} show`")]
    NotAcquired {
        /// The place.
        place: String,
        /// What the coordinator said.
        said: String,
    },
    /// labgrid's coordinator refused to release the place.
    #[error("labgrid does not take the place {place} back; see `labgrid-client -p {place} show`")]
    NotReleased {
        /// The place.
        place: String,
    },
    /// What held labgrid's place has ended while the board was judged, so the place may be somebody else's.
    #[error(
        "labgrid's place {place} is no longer held for this station: what held it ended with {status}; look at labgrid's coordinator"
    )]
    Lost {
        /// The place.
        place: String,
        /// How it ended.
        status: String,
    },
    /// labgrid's place has no serial port.
    #[error(
        "labgrid's place {place} has no NetworkSerialPort; give it one by `labgrid-client -p {place} add-match`"
    )]
    NoPort {
        /// The place.
        place: String,
    },
    /// labgrid's place has several serial ports, and none of them is called halfrow.
    #[error(
        "labgrid's place {place} has several ports ({ports}); call the board's one halfrow, by `labgrid-client -p {place} add-named-match`"
    )]
    SeveralPorts {
        /// The place.
        place: String,
        /// Their names.
        ports: String,
    },
    /// The exporter of labgrid's place does not have the serial port.
    #[error(
        "the port of labgrid's place {place} is not there; look at its exporter, and whether the board is plugged in"
    )]
    PortAway {
        /// The place.
        place: String,
    },
    /// The serial port of labgrid's place is exported by a protocol that adds bytes of its own to the board's.
    #[error(
        "the port of labgrid's place {place} is exported by {protocol}, and halfrow needs raw bytes; have ser2net serve it by plain TCP, and \
         export that as a NetworkSerialPort with protocol: raw"
    )]
    Protocol {
        /// The place.
        place: String,
        /// How it is exported.
        protocol: String,
    },
}

/// What the program that reaches labgrid answers.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum HelperReply {
    Held(Port),
    Freed,
    Refused(Why),
}

/// Where the port of a place is.
#[derive(Debug, Deserialize)]
pub(super) struct Port {
    pub(super) host: String,
    pub(super) port: u16,
    /// In baud, where the exporter says one.
    pub(super) speed: Option<u32>,
}

/// Why there is no port.
#[derive(Debug, Deserialize)]
#[serde(tag = "why", rename_all = "kebab-case")]
pub(super) enum Why {
    CoordinatorAway { coordinator: String },
    Unknown { known: String },
    Held { holder: String },
    NotAcquired { said: String },
    NotReleased,
    NoPort,
    SeveralPorts { ports: String },
    PortAway,
    Protocol { protocol: String },
}

impl Why {
    /// Turns it into an error about the place.
    pub(super) fn of(self, place: String) -> LabgridError {
        match self {
            Self::CoordinatorAway { coordinator } => LabgridError::CoordinatorAway { coordinator },
            Self::Unknown { known } => LabgridError::Unknown { place, known },
            Self::Held { holder } => LabgridError::Held { place, holder },
            Self::NotAcquired { said } => LabgridError::NotAcquired { place, said },
            Self::NotReleased => LabgridError::NotReleased { place },
            Self::NoPort => LabgridError::NoPort { place },
            Self::SeveralPorts { ports } => LabgridError::SeveralPorts { place, ports },
            Self::PortAway => LabgridError::PortAway { place },
            Self::Protocol { protocol } => LabgridError::Protocol { place, protocol },
        }
    }
}
