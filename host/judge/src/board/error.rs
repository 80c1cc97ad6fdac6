//! Why a board could not be driven.

use std::error::Error;
use std::fmt;
use std::time::Duration;

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Malformed, Refusal, RefusalCode, RowPlace};

use super::Tally;
use super::conversation::Conversation;
use super::nature::{Shown, is_own};
use super::received::{Had, Received, suspect, suspect_of_one};
use crate::link::LinkError;
use crate::verdict::{Cause, StoppedBy};
use crate::words::{count, span};

/// Why a board could not be driven.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The link to the board broke during the run.
    #[error("the link broke while {doing}")]
    Link {
        /// What was under way.
        doing: String,
        /// How.
        #[source]
        source: Box<LinkError>,
    },
    /// A server has turned the host away in words, so that no link came about.
    #[error(transparent)]
    TurnedAway(Box<LinkError>),
    /// The board did not answer a request, although it was sent several times.
    #[error(
        "no answer to {kind} in {} ({:.1} s){}",
        count(*.attempts, "try"),
        waited.as_secs_f64(),
        suspect(*.heard)
    )]
    NoAnswer {
        /// The request.
        kind: Kind,
        /// Tries.
        attempts: u32,
        /// Time in all.
        waited: Duration,
        /// What had come by then.
        heard: Received,
    },
    /// The board did not answer a request, although it was sent several times, and answered others meanwhile.
    #[error(
        "no answer to {kind} with {} in {}, and to this alone: {}",
        count(*.bytes, "byte"),
        count(*.attempts, "try"),
        suspect_of_one(*.had)
    )]
    Unanswered {
        /// The request.
        kind: Kind,
        /// Bytes of its payload.
        bytes: usize,
        /// Tries.
        attempts: u32,
        /// What the board counts of it.
        had: Had,
    },
    /// Each try of a request reached the board damaged, by the board's own count, while it answered others.
    #[error(
        "no answer to {kind} with {} in {}, because the board counts each as a damaged packet, though it answered others at once \
         and nothing came back damaged; check the cable and the rate, and then how the board undoes the stuffing of long packets, \
         with 254 bytes and more without a zero (protocol/WIRE.md, section 1, and protocol/vectors)",
        count(*.bytes, "byte"),
        count(*.attempts, "try")
    )]
    DamagedEachTime {
        /// The request.
        kind: Kind,
        /// Bytes of its payload.
        bytes: usize,
        /// Tries.
        attempts: u32,
    },
    /// The board's packets end without a zero.
    #[error(
        "the board sends its packets without the zero that must follow each of them, so that each is complete only when the next one \
         begins; check that the board sends a zero behind every packet (protocol/WIRE.md, section 1), and that nothing on the way \
         holds back the last byte"
    )]
    Unclosed,
    /// A device answered, but not as a halfrow board does.
    #[error(
        "the device that answers is not a halfrow board; check the target and what is loaded into the FPGA"
    )]
    NotABoard,
    /// The bytes that were sent came back unchanged, and no board answered.
    #[error(
        "the line returns what is sent to it, instead of a board's answer; look for a loopback plug, for TX and RX \
         that touch, and for a port that echoes"
    )]
    Echoed,
    /// The board claims a capability that no board can have, so no command can use it.
    #[error(
        "the board says {capability} = {value}, but {legal}; correct what it says of itself (CAPABILITIES in \
         protocol/WIRE.md), or load another bitstream"
    )]
    Impossible {
        /// The capability.
        capability: String,
        /// What the board says.
        value: u16,
        /// What may be, as the end of a sentence.
        legal: String,
    },
    /// The bytes that were sent came back with others added, as a console echoes them.
    #[error(
        "the bytes that are sent come back, with {} more: the device at this port has a console, like a modem or a \
         Linux system, and is not a halfrow board; choose another port",
        count(*bytes, "byte")
    )]
    Console {
        /// What came beyond what was sent.
        bytes: u64,
    },
    /// The board and this program have no version of the wire in common.
    #[error(
        "the board speaks version {board} of the wire and this program version {ours}; load a matching bitstream or \
         install a matching halfrow"
    )]
    Version {
        /// The board's newest.
        board: u16,
        /// This program's.
        ours: u8,
    },
    /// Another host is using the board.
    #[error(
        "another host holds the board; wait until it is done (silent for 10 s, of which {seconds:.1} s are left), \
         or take the board over"
    )]
    Held {
        /// What is left of the ten seconds.
        seconds: f64,
    },
    /// Another host is using the board, and the board was told to leave it.
    #[error(
        "another host holds the board, and the board was told to let this one take it over and refuses, which protocol/WIRE.md \
         (Sessions, 3) forbids; wait until the other is done (silent for 10 s, of which {seconds:.1} s are left), or switch the \
         board off and on"
    )]
    NotGivenUp {
        /// What is left of the ten seconds.
        seconds: f64,
    },
    /// The board no longer knows the host's session: it was reset or lost power, another host took it over, or this computer sent
    /// nothing for 10 s. Then another host may take the board, and a burst ends with its session.
    #[error("the board no longer knows this session: {}", lost_by(*.silent))]
    SessionLost {
        /// How long nothing had been sent before the request that was refused; zero if that is not known.
        silent: Duration,
    },
    /// The board refused a request. If it refuses a kind, a payload, taps or, most often, a range, the board does not do
    /// what it says that it can. If a table reads back with another CRC, its memory may be faulty. Any other refusal may come
    /// from another host or from an old packet.
    #[error(
        "the board refused {kind}: {code} (detail {detail}){}", advice(.refusal), kind = .kind, code = .refusal.code,
        detail = .refusal.detail
    )]
    Refused {
        /// The request.
        kind: Kind,
        /// Its reason.
        refusal: Refusal,
    },
    /// The board's answer cannot be understood, although its CRC is right.
    #[error("the board's answer to {kind} makes no sense; load a bitstream that this halfrow is made for")]
    Malformed {
        /// The request.
        kind: Kind,
        /// What is wrong.
        #[source]
        source: Malformed,
    },
    /// The board answered with a message of another kind than the request calls for.
    #[error("the board answered {kind} with something else; load a bitstream that this halfrow is made for")]
    Unexpected {
        /// The request.
        kind: Kind,
    },
    /// The board is making another burst than the one asked for last, over a link on which requests arrived twice.
    #[error(
        "the board runs another burst than the one asked for last, and {} reached it twice: a late copy may have restarted an \
         earlier burst; check the cable, its connectors and the link, then run again",
        count(*again, "request")
    )]
    OtherBurst {
        /// Requests that came twice.
        again: u64,
    },
    /// More packets had to be sent again than the retry limit allows.
    #[error(
        "the link is too poor to judge a board over: {retries} of {packets} packets had to be sent again, and {limit} \
         are allowed; check cable, connectors and rate, or raise the retry limit, and if `halfrow link` finds the link good, \
         find out why the board answers late or not at all"
    )]
    TooPoor {
        /// Packets sent again.
        retries: u64,
        /// Packets sent.
        packets: u64,
        /// The limit at that many packets.
        limit: u64,
    },
    /// A row did not come back from the board.
    #[error(
        "row {row} of frame {frame} did not come back in {}; run `halfrow verify` to find out whether the board or the \
         link loses it", count(*.attempts, "try"), row = .place.row, frame = .place.frame
    )]
    RowMissing {
        /// The row.
        place: RowPlace,
        /// Tries.
        attempts: u32,
    },
    /// A row came back with the place of a row that was never sent.
    #[error(
        "the board returned row {row} of frame {frame} with a place that was never sent; load a bitstream that this \
         halfrow is made for", row = .place.row, frame = .place.frame
    )]
    WrongPlace {
        /// The place that the board named.
        place: RowPlace,
    },
    /// The run did not end within its time limit.
    #[error("the run did not end within its time limit of {}{}", span(limit.as_secs_f64()), slow_or_silent(*silent))]
    Timeout {
        /// The limit.
        limit: Duration,
        /// How long no packet had come by then.
        silent: Duration,
    },
    /// Somebody stopped the run, and the board was not judged.
    #[error("{0}, and the board is not judged; run again")]
    Stopped(StoppedBy),
}

/// A board that could not be opened.
#[derive(Debug)]
pub struct OpenFailed {
    /// Why.
    pub error: BoardError,
    /// What the link did up to then.
    pub tally: Box<Tally>,
    /// When that was, on the link's clock.
    pub at: Duration,
}

impl OpenFailed {
    pub(super) fn of(error: BoardError, conversation: &Conversation) -> Self {
        Self { error, tally: Box::new(conversation.tally), at: conversation.now() }
    }
}

impl fmt::Display for OpenFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl Error for OpenFailed {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}

impl From<OpenFailed> for BoardError {
    fn from(failed: OpenFailed) -> Self {
        failed.error
    }
}

/// Whether a request of `kind` needs no capability.
fn is_of_every_board(kind: Kind) -> bool {
    use Kind::{Burst, Expect, Records, RowOut, Trap};
    !matches!(kind, Burst | Records | Expect | Trap | RowOut)
}

/// What to do about a refusal.
fn advice(refusal: &Refusal) -> &'static str {
    match refusal.code {
        RefusalCode::Kind if Kind::from_code(refusal.kind).is_some_and(is_of_every_board) => {
            "; every board must answer it: see protocol/WIRE.md, section 3"
        }
        _ if is_own(refusal) => {
            "; its capabilities allow that: correct what it says of itself (`halfrow info`), or load another bitstream"
        }
        RefusalCode::TableCrc => {
            "; run `halfrow verify`, which reads the tables back and names what is wrong in them"
        }
        RefusalCode::Busy => "; stop whatever else feeds the board's core, then run again",
        _ => "; run again, and if it refuses each time, load a bitstream that follows protocol/WIRE.md",
    }
}

/// After this silence of its host a board may end a session (protocol/WIRE.md, Sessions).
const FORGOTTEN: Duration = Duration::from_secs(10);

/// Why a board no longer knows a session whose host sent nothing for the time `silent`, and what to do about it.
fn lost_by(silent: Duration) -> String {
    if silent < FORGOTTEN {
        return "it was reset or lost power, another host took it over, or this computer was suspended or overloaded while the board \
                made frames; run again"
            .to_owned();
    }
    format!(
        "this computer sent it nothing for {}, as when it is stopped by Ctrl-Z, suspended or overloaded, after which a board may end \
         the session and another host may take it; keep this computer and program running, and run again",
        span(silent.as_secs_f64())
    )
}

/// After this silence a run is not merely slow.
const SILENT: Duration = Duration::from_secs(1);

/// What to do about a run that did not end in time.
fn slow_or_silent(silent: Duration) -> String {
    if silent < SILENT {
        return "; give it more time, or use a faster link".to_owned();
    }
    let silent = span(silent.as_secs_f64());
    format!(
        ", and no packet came in the last {silent} of it; check that the board still has power, the cable and its connectors"
    )
}

impl BoardError {
    /// What became of the link while `doing` was under way.
    pub(super) fn of_link(doing: String, source: LinkError) -> Self {
        let source = Box::new(source);
        match *source {
            LinkError::InUse { .. } | LinkError::NoBoardThere { .. } => Self::TurnedAway(source),
            _ => Self::Link { doing, source },
        }
    }

    /// Whether something answers or holds the port, but is no board for this run at present.
    #[must_use]
    pub(crate) fn shows_device(&self) -> bool {
        self.nature().is_device
    }

    /// Whether the board's answer is one that no sound board gives to that request.
    #[must_use]
    pub(crate) fn is_answer(&self) -> bool {
        self.shown().is_some_and(Shown::is_answer)
    }

    /// What it shows of the board.
    pub(crate) fn shown(&self) -> Option<Shown> {
        self.nature().shown
    }

    /// The cause of a run that ends with this error.
    #[must_use]
    pub fn cause(&self) -> Cause {
        self.nature().cause
    }
}
