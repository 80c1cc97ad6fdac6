//! Asks a device whether it is a board. This sends a greeting to it, whatever the device is.

use crate::board::{Board, BoardError, Capabilities, OpenOptions, Received, WhenHeld};
use crate::link::discovery::Answer;
use crate::link::{self, Class, OpenError};
use crate::result::Problem;
use crate::target::Target;
use crate::verdict::Cause;

/// Opens `target` and greets the device there, as often as a run does. If nothing answers this takes about two seconds, or a
/// minute at 9600 baud, in addition to the time to connect.
#[must_use]
pub fn probe(target: &Target) -> Answer {
    let candidate = match link::open(target) {
        Ok(candidate) => candidate,
        Err(error) => return not_opened(&error),
    };
    let options = OpenOptions { when_held: WhenHeld::Leave, ..OpenOptions::default() };
    let greeted = Board::with(candidate.link, &options, |board| board.capabilities.clone());
    match greeted.map_err(BoardError::from) {
        Ok(Capabilities { name, datapath, .. }) => Answer::Board { name, datapath },
        Err(BoardError::Held { .. }) => Answer::Held,
        Err(BoardError::NoAnswer { heard: Received { bytes: 0, .. }, .. }) => Answer::Silent,
        Err(BoardError::NoAnswer { heard: Received { packets: 0, bytes, .. }, .. }) => {
            Answer::Babble { bytes }
        }
        Err(error) if error.cause() == Cause::Busy => Answer::Busy,
        Err(error) if error.shows_device() || error.is_answer() => {
            Answer::Foreign { reason: Problem::of(&error).sentence() }
        }
        Err(error) => Answer::Failed { reason: Problem::of(&error).sentence() },
    }
}

fn not_opened(error: &OpenError) -> Answer {
    match error.class() {
        Class::Busy => Answer::Busy,
        _ => Answer::Failed { reason: Problem::of(error).sentence() },
    }
}
