//! A recording as a link: it answers, byte for byte and at the same times, as the board did.

use std::time::Duration;

use super::{Link, LinkError, Recording, RecordingError};

/// A pipe to a board that answered once.
#[derive(Debug)]
pub(crate) struct ReplayLink {
    name: String,
    bytes_per_second: Option<f64>,
    exclusive: bool,
    recording: Recording,
    /// Where its next exchange is.
    place: usize,
    now: Duration,
    sent: u64,
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
        Ok(Self { name, bytes_per_second, exclusive, recording, place, now: Duration::ZERO, sent: 0 })
    }
}

impl Link for ReplayLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        _wait: Duration,
    ) -> Result<usize, LinkError> {
        let Some(exchange) = self.recording.next(&mut self.place) else {
            return Err(LinkError::Closed { link: self.name.clone(), at: self.now });
        };
        let same = exchange.taken.iter().zip(outgoing).take_while(|(then, now)| then == now).count();
        if same < exchange.taken.len() {
            return Err(LinkError::OtherConversation { byte: self.sent + same as u64 });
        }
        self.sent += same as u64;
        self.now = exchange.at;
        incoming.extend_from_slice(exchange.received);
        Ok(exchange.taken.len())
    }

    fn now(&self) -> Duration {
        self.now
    }

    // The deadlines are sized by it, so it is part of the conversation.
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
