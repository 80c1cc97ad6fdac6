//! Asks a device whether it is a board. That writes a greeting to it, whatever it is.

use serde::Serialize;

use crate::board::{Board, BoardError, OpenOptions};
use crate::link::{self, OpenError};
use crate::session::Draws;
use crate::target::Target;
use crate::verdict::Exit;

/// What came of asking.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub enum Answer {
    /// A halfrow board answered, and was left free.
    Board {
        /// Its name.
        name: String,
        /// The datapath that it computes.
        datapath: u16,
    },
    /// A halfrow board answered that another host holds it.
    Held,
    /// Something answered, and not as this program's boards do.
    Foreign {
        /// Why it is none.
        reason: String,
    },
    /// Nothing answered.
    Silent,
    /// It is open elsewhere.
    Busy,
    /// It could not be opened.
    Failed {
        /// Why.
        reason: String,
    },
}

/// Opens `target` and greets what is there, as often as a run does. Takes some two seconds if nothing answers, beside the
/// time to connect.
#[must_use]
pub fn probe(target: &Target) -> Answer {
    let candidate = match link::open(target) {
        Ok(candidate) => candidate,
        Err(error) => return not_opened(&error),
    };
    let Draws { nonce, host } = Draws::draw();
    let options = OpenOptions { nonce, host, polite: true, ..OpenOptions::default() };
    match Board::open(candidate.link, &options) {
        Ok(mut board) => {
            let (name, datapath) = (board.capabilities.name.clone(), board.capabilities.datapath);
            if let Err(error) = board.close() {
                tracing::info!("the session was not closed: {error}");
            }
            Answer::Board { name, datapath }
        }
        Err((BoardError::Held { .. }, _)) => Answer::Held,
        Err((BoardError::NoAnswer { .. }, _)) => Answer::Silent,
        Err((error @ (BoardError::NotABoard | BoardError::Version { .. }), _)) => {
            Answer::Foreign { reason: error.to_string() }
        }
        Err((error, _)) if error.exit() == Exit::Busy => Answer::Busy,
        Err((error, _)) => {
            let error = anyhow::Error::from(error);
            Answer::Failed { reason: format!("{error:#}") }
        }
    }
}

fn not_opened(error: &OpenError) -> Answer {
    if error.exit() == Exit::Busy { Answer::Busy } else { Answer::Failed { reason: error.to_string() } }
}
