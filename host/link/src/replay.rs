//! A recording as a link: it answers as the board did, byte for byte and at the same times.

use std::time::Duration;

use super::{Link, LinkError, Recording, RecordingError};

/// The most bytes that a stopped host sends to close its session: a RESET, sent more than once.
const PARTING: usize = 128;

/// A pipe to a recorded board.
#[derive(Debug)]
pub(crate) struct ReplayLink {
    name: String,
    bytes_per_second: Option<f64>,
    exclusive: bool,
    recording: Recording,
    /// The offset of the next exchange.
    place: usize,
    now: Duration,
    sent: u64,
    /// Whether the host already waited once where the recorded one sent.
    waited: bool,
}

impl ReplayLink {
    /// A link that repeats `recording`.
    ///
    /// # Errors
    /// [`RecordingError::Head`] when the recording's head does not parse.
    pub(crate) fn new(recording: Recording) -> Result<Self, RecordingError> {
        let name = format!("the recording {}", recording.path().display());
        let bytes_per_second = recording.bytes_per_second()?;
        let exclusive = recording.is_exclusive()?;
        let place = recording.start();
        Ok(Self {
            name,
            bytes_per_second,
            exclusive,
            recording,
            place,
            now: Duration::ZERO,
            sent: 0,
            waited: false,
        })
    }
}

impl ReplayLink {
    fn ended(&self) -> LinkError {
        LinkError::RecordingEnds { link: self.name.clone(), at: self.now }
    }
}

impl Link for ReplayLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        _wait: Duration,
    ) -> Result<usize, LinkError> {
        let mut behind = self.place;
        let Some(exchange) = self.recording.next(&mut behind) else {
            return Err(self.ended());
        };
        // A host that waits by the clock stops at another time than the recorded one did, since a recording has no clock between
        // its exchanges.
        let waits = outgoing.is_empty() && !exchange.taken.is_empty();
        if waits && !std::mem::replace(&mut self.waited, waits) {
            return Ok(0);
        }
        (self.place, self.waited) = (behind, false);
        let same = exchange.taken.iter().zip(outgoing).take_while(|(then, now)| then == now).count();
        let others = exchange.taken.len() - same;
        if others > 0 {
            let is_parting = others + self.recording.sent_from(self.place) <= PARTING;
            let byte = self.sent + same as u64;
            return Err(if is_parting { self.ended() } else { LinkError::OtherConversation { byte } });
        }
        self.sent += same as u64;
        self.now = exchange.at;
        incoming.extend_from_slice(exchange.received);
        Ok(exchange.taken.len())
    }

    fn now(&self) -> Duration {
        self.now
    }

    // Deadlines are computed from it, so it is part of the conversation.
    fn bytes_per_second(&self) -> Option<f64> {
        self.bytes_per_second
    }

    fn is_exclusive(&self) -> bool {
        self.exclusive
    }

    fn name(&self) -> String {
        self.name.clone()
    }
}
