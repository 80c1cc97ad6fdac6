//! A link: a pipe that carries bytes to a board and back, with deadlines. [`open`] opens the one that a [`Target`] names, and
//! [`discovery`] finds what could be a board.
//!
//! Cargo's feature `sim` adds the targets `sim`, `sim:uart` and `sim:fifo`, which are the board's Verilog under simulation. It
//! needs Verilator and a C++ compiler.

#![warn(missing_debug_implementations)]

#[cfg(not(target_os = "linux"))]
compile_error!("halfrow-link is for Linux alone; docs/portable.md says what works elsewhere");

mod access;
mod candidate;
mod class;
mod closed_link;
pub mod descriptor;
pub mod discovery;
mod error;
mod ftdi;
pub mod kinds;
mod line_errors;
mod mock_board;
mod open;
mod options;
mod recording;
mod replay;
mod serial;
#[cfg(feature = "sim")]
mod simulated;
mod sysfs;
pub mod target;
mod tcp;
mod usb;
mod wire;

use std::time::Duration;

pub use halfrow_mock as mock;
pub use halfrow_pipe as pipe;

pub use candidate::{Candidate, Reopener};
pub use class::Class;
pub use closed_link::ClosedLink;
pub use error::OpenError;
pub use line_errors::LineErrors;
pub use mock_board::fault;
pub use open::{WRITTEN_FILE, check, open, written_file};
pub use recording::{Lost, Recorder, Recording, RecordingError, RecordingFile};
pub use replay::{recording, recording_file, replay};
pub(crate) use serial::SerialLink;
pub use serial::{Holder, SerialBoard, SerialError, holders};
pub use sysfs::UsbDevice;
pub(crate) use sysfs::usb_device;
pub use target::{BoardKind, Target, TargetError};
pub use tcp::TcpError;
pub(crate) use tcp::TcpLink;
pub use usb::{UsbBoard, UsbError, UsbFailure};
pub(crate) use usb::{UsbLink, usb_boards};
pub use wire::WireLink;

#[cfg(feature = "sim")]
pub use halfrow_sim::TraceError;
/// Why the waveform of a simulated board is not written. Cargo unites features over a build, so the errors have the same variants
/// without the feature `sim`.
#[cfg(not(feature = "sim"))]
pub use std::convert::Infallible as TraceError;

/// The bytes a second that a line of this rate carries: a byte is a start bit, eight data bits and a stop bit.
pub fn bytes_per_second(baud: impl Into<f64>) -> f64 {
    baud.into() / 10.0
}

/// The longest wait of a link that takes real time, so that a request to stop is noticed. The waits of a run for frames made by the
/// board are no longer either.
pub(crate) const HEED: Duration = Duration::from_millis(250);

/// A byte pipe to a board. It can be sent to another thread, so several boards can be judged at the same time.
///
/// Both directions move in one call, so a host cannot deadlock with a board that waits to be read: what the board sends is taken
/// while the host sends.
///
/// A program can bring a link of its own in a [`Candidate`]; the front page of `halfrow` has an example.
pub trait Link: Send {
    /// Writes what the pipe takes of `outgoing`, appends to `incoming` what has arrived, and returns the number of bytes taken, at
    /// most `outgoing.len()`. Returns as soon as a byte has moved in either direction. Without one it returns when `wait` has
    /// passed, or earlier: after a signal, or so that the caller can check whether it was asked to stop. So 0 does not mean that
    /// `wait` is over; see [`Self::now`]. It may also take some milliseconds longer than `wait`.
    ///
    /// # Errors
    /// [`LinkError`] when the pipe is broken. Bytes that moved before were returned by earlier calls.
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError>;

    /// The link's own clock, which starts when the link opens. Deadlines follow it, so a link on a virtual clock times out in
    /// virtual time.
    fn now(&self) -> Duration;

    /// The bytes a second that the slower direction carries, if known.
    fn bytes_per_second(&self) -> Option<f64>;

    /// Whether nobody else can reach the board while the link is open. Then a session of another host must be that of a killed
    /// program.
    fn is_exclusive(&self) -> bool {
        false
    }

    /// Whether nothing is sent unless the board's end drives CTS.
    fn waits_for_cts(&self) -> bool {
        false
    }

    /// Its name, for people.
    fn name(&self) -> String;

    /// What the chip at the near end has seen go wrong on the line; all zero for a link that cannot tell.
    fn line_errors(&self) -> LineErrors {
        LineErrors::default()
    }
}

/// A pipe that broke.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The other end closed the link.
    #[error("{link} was closed at {:.3} s; check the cable and the board's power, then run again", at.as_secs_f64())]
    Closed {
        /// The link's name.
        link: String,
        /// When, on the link's clock.
        at: Duration,
    },
    /// The program at the far end of a connection closed it.
    #[error(
        "{link} was closed at {:.3} s by the program at its far end: it was ended, lost its device, or gave the board to another \
         host; look at its log, then run again",
        at.as_secs_f64()
    )]
    ClosedAfar {
        /// The link's name.
        link: String,
        /// When, on the link's clock.
        at: Duration,
    },
    /// A board that runs inside this program has failed.
    #[error("{board} stopped at {:.3} s; run again, and report it if it stops once more", at.as_secs_f64())]
    Stopped {
        /// Which board.
        board: &'static str,
        /// When, on the link's clock.
        at: Duration,
        /// Why.
        #[source]
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The waveform of the simulated board cannot be written on; only with Cargo's feature `sim`.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The board's device is gone: it was unplugged or lost power.
    #[error(
        "{link} went away at {:.3} s: the board was unplugged or lost power; plug it in, then run again",
        at.as_secs_f64()
    )]
    Unplugged {
        /// The link's name.
        link: String,
        /// When, on the link's clock.
        at: Duration,
    },
    /// The server at the far end says that another host is using the board.
    #[error("{link} was turned away with `{text}`: another host is connected; wait until it is done")]
    InUse {
        /// The link's name.
        link: String,
        /// What the server said.
        text: String,
    },
    /// The server at the far end has no board to connect to, and says so in words.
    #[error(
        "{link} answered with the words `{text}` and no board: plug the board in at the far end, and check the device \
         that its ser2net names"
    )]
    NoBoardThere {
        /// The link's name.
        link: String,
        /// What the server said.
        text: String,
    },
    /// The system reported a failure of the link.
    #[error("{link} failed at {:.3} s; check the cable, then run again", at.as_secs_f64())]
    Failed {
        /// The link's name.
        link: String,
        /// When, on the link's clock.
        at: Duration,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// This run sends other bytes than the run that made the recording.
    #[error(
        "from byte {byte} on, this run sends something else than the recorded one; replay it with the program, \
         tables and frames of the run that made it"
    )]
    OtherConversation {
        /// The first byte that differs, counted from the beginning.
        byte: u64,
    },
    /// The recording ends, but the run would go on.
    #[error(
        "{link} ends at {:.3} s, where the run that made it was interrupted, lost its link or had no more to do; record a whole \
         run with this program, over a link that does not break", at.as_secs_f64()
    )]
    RecordingEnds {
        /// The recording.
        link: String,
        /// When, on the link's clock.
        at: Duration,
    },
    /// The recording could not be written.
    #[error("the recording could not be written; free some space or choose another place for the recording")]
    Record(#[source] std::io::Error),
}
