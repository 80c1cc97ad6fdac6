//! What each error says of the board, and of a run that ends with it.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Refusal, RefusalCode};

use super::BoardError;
use crate::link::LinkError;
use crate::verdict::Cause;

/// What an error shows of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// The board went away, as when it was unplugged or lost power, and may come back.
    Outage,
    /// The board cannot be reached, and waiting does not help.
    Unreachable,
    /// The board gave an answer that no sound board gives after what the run asked of it.
    Answer,
    /// Such an answer: it refused a row of the run because it was beyond the window.
    NoCredit,
    /// Such an answer: it refused a row or a burst because it had no configuration or no tables.
    NotReady,
}

impl Shown {
    /// Whether the board gave an answer that no sound board gives after what the run asked of it.
    pub(crate) fn is_answer(self) -> bool {
        matches!(self, Self::Answer | Self::NoCredit | Self::NotReady)
    }
}

/// What an error means.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nature {
    pub(super) shown: Option<Shown>,
    /// Whether something answers or holds the port, but is no board for this run at present.
    pub(super) is_device: bool,
    /// The cause of a run that ends with it.
    pub(super) cause: Cause,
}

impl Nature {
    const fn of(shown: Option<Shown>, cause: Cause) -> Self {
        Self { shown, is_device: false, cause }
    }

    const fn of_device(shown: Option<Shown>, cause: Cause) -> Self {
        Self { shown, is_device: true, cause }
    }
}

impl BoardError {
    pub(super) fn nature(&self) -> Nature {
        use Cause::{Busy, Refused, Station};
        match self {
            Self::Link { source, .. } => Nature::of(Some(of_link(source)), Station),
            Self::TurnedAway(by) if matches!(**by, LinkError::InUse { .. }) => {
                Nature::of_device(Some(Shown::Unreachable), Busy)
            }
            Self::TurnedAway(_) => Nature::of(Some(Shown::Unreachable), Station),
            Self::NoAnswer { .. } | Self::SessionLost { .. } => Nature::of(Some(Shown::Outage), Station),
            Self::Held { .. } | Self::NotGivenUp { .. } => Nature::of_device(None, Busy),
            Self::NotABoard | Self::Version { .. } | Self::Impossible { .. } | Self::Unclosed => {
                Nature::of_device(None, Refused)
            }
            Self::Echoed | Self::Console { .. } => Nature::of_device(None, Station),
            Self::Malformed { .. } => Nature::of_device(Some(Shown::Answer), Refused),
            Self::Refused { kind: Kind::RowIn, refusal } if refusal.code == RefusalCode::Credit => {
                Nature::of(Some(Shown::NoCredit), Station)
            }
            Self::Refused { kind: Kind::RowIn | Kind::Burst, refusal }
                if refusal.code == RefusalCode::NotReady =>
            {
                Nature::of(Some(Shown::NotReady), Station)
            }
            Self::Refused { refusal, .. } => {
                Nature::of(Some(Shown::Answer), if is_own(refusal) { Refused } else { Station })
            }
            Self::Unexpected { .. } | Self::OtherBurst { .. } | Self::WrongPlace { .. } => {
                Nature::of(Some(Shown::Answer), Station)
            }
            Self::Unanswered { .. }
            | Self::DamagedEachTime { .. }
            | Self::TooPoor { .. }
            | Self::RowMissing { .. }
            | Self::Timeout { .. } => Nature::of(None, Station),
            Self::Stopped(by) => Nature::of(None, Cause::Stopped(*by)),
        }
    }
}

fn of_link(error: &LinkError) -> Shown {
    match error {
        LinkError::Closed { .. }
        | LinkError::ClosedAfar { .. }
        | LinkError::Failed { .. }
        | LinkError::Unplugged { .. } => Shown::Outage,
        LinkError::Trace(_)
        | LinkError::Stopped { .. }
        | LinkError::InUse { .. }
        | LinkError::NoBoardThere { .. }
        | LinkError::OtherConversation { .. }
        | LinkError::RecordingEnds { .. }
        | LinkError::Record(_) => Shown::Unreachable,
    }
}

/// Whether a request is refused only for its content and the board's abilities, whatever the board did before. Then the board
/// does not do what its capabilities say, since this program asks for nothing else.
pub(super) fn is_own(refusal: &Refusal) -> bool {
    use Kind::{Burst, Configure, Expect, TableCrc, TableRead, TableWrite};
    let kind = Kind::from_code(refusal.kind);
    match refusal.code {
        RefusalCode::Kind | RefusalCode::Payload | RefusalCode::Taps => true,
        // A range of COMMIT, RECORDS and rows depends on what was set and played before.
        RefusalCode::Range => {
            matches!(kind, Some(Burst | Configure | Expect | TableCrc | TableRead | TableWrite))
        }
        _ => false,
    }
}
