//! Asks a device whether it is a board. That writes a greeting to it, whatever it is.

use std::time::Duration;

use crate::board::{Board, BoardError, OpenOptions, Stop};
use crate::link::discovery::Answer;
use crate::link::{self, Class, OpenError};
use crate::run::Draws;
use crate::target::Target;
use crate::verdict::Cause;

/// Three greetings' time: a board answers the first, unless stale bytes are in its way.
const PATIENCE: Duration = Duration::from_millis(1000);

/// Opens `target` and greets what is there. Takes a second at most if nothing answers, beside the time to connect.
#[must_use]
pub fn probe(target: &Target) -> Answer {
    let candidate = match link::open(target) {
        Ok(candidate) => candidate,
        Err(error) => return not_opened(&error),
    };
    let Draws { nonce, host } = Draws::draw();
    let stop = Stop::default().limited(Some(PATIENCE));
    let options = OpenOptions { nonce, host, polite: true, stop, ..OpenOptions::default() };
    match Board::open(candidate.link, &options) {
        Ok(mut board) => {
            let (name, datapath) = (board.capabilities.name.clone(), board.capabilities.datapath);
            if let Err(error) = board.close() {
                tracing::info!("the session was not closed: {error}");
            }
            Answer::Board { name, datapath }
        }
        Err((BoardError::Held { .. }, _)) => Answer::Held,
        Err((BoardError::NoAnswer { .. } | BoardError::Timeout { .. }, _)) => Answer::Silent,
        Err((error @ (BoardError::NotABoard | BoardError::Version { .. }), _)) => {
            Answer::Foreign { reason: error.to_string() }
        }
        Err((error, _)) if error.cause() == Cause::Busy => Answer::Busy,
        Err((error, _)) => Answer::Failed { reason: crate::run::chain(&error) },
    }
}

fn not_opened(error: &OpenError) -> Answer {
    if error.class() == Class::Busy { Answer::Busy } else { Answer::Failed { reason: error.to_string() } }
}
