//! A recording as a link: it answers as the board did, byte for byte and at the same times.

use std::path::Path;
use std::time::Duration;

use serde::de::IgnoredAny;

use super::{Candidate, LineErrors, Link, LinkError, OpenError, Recording, RecordingError};
use crate::recording::Head;
use crate::target::{BoardKind, Target};

/// The most bytes that a stopped host sends to close its session: a RESET, sent more than once.
const PARTING: usize = 128;

/// A pipe to a recorded board.
#[derive(Debug)]
pub(crate) struct ReplayLink {
    name: String,
    /// What the recorded link told of itself.
    head: Head<IgnoredAny>,
    line_errors: LineErrors,
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
        let head = recording.head()?;
        let place = recording.start();
        Ok(Self {
            name,
            head,
            line_errors: LineErrors::default(),
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
        self.line_errors = exchange.line_errors.unwrap_or(self.line_errors);
        incoming.extend_from_slice(exchange.received);
        Ok(exchange.taken.len())
    }

    fn now(&self) -> Duration {
        self.now
    }

    // Deadlines are computed from it, so it is part of the conversation.
    fn bytes_per_second(&self) -> Option<f64> {
        self.head.bytes_per_second
    }

    fn is_exclusive(&self) -> bool {
        self.head.exclusive
    }

    fn waits_for_cts(&self) -> bool {
        self.head.waits_for_cts
    }

    fn name(&self) -> String {
        self.name.clone()
    }

    fn line_errors(&self) -> LineErrors {
        self.line_errors
    }
}

pub(crate) fn open_replay(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    Ok(Box::new(ReplayLink::new(read_replay(target)?)?))
}

/// The recording that `target` names; none for another kind of target.
///
/// # Errors
/// [`OpenError`] when it names no file, or the file is no recording.
pub fn recording(target: &Target) -> Result<Option<Recording>, OpenError> {
    if target.kind == "replay" { read_replay(target).map(Some) } else { Ok(None) }
}

/// The file of the recording that `target` names; none for another kind of target.
#[must_use]
pub fn recording_file(target: &Target) -> Option<&Path> {
    target.address.as_deref().filter(|_| target.kind == "replay").map(Path::new)
}

/// The board that answered in `recording`, which `target` names.
///
/// # Errors
/// [`OpenError::Recording`] when its head is damaged.
pub fn replay(target: &Target, recording: Recording) -> Result<Candidate, OpenError> {
    let link = Box::new(ReplayLink::new(recording)?);
    Ok(Candidate { target: target.to_string(), kind: BoardKind::Replay, link, reopen: None })
}

pub(crate) fn check_replay(target: &Target) -> Result<(), OpenError> {
    file_of(target).map(|_| ())
}

fn read_replay(target: &Target) -> Result<Recording, OpenError> {
    Ok(Recording::read(Path::new(file_of(target)?))?)
}

fn file_of(target: &Target) -> Result<&str, OpenError> {
    let file = target.address.as_deref().filter(|file| !file.is_empty());
    file.ok_or_else(|| OpenError::address_missing(target))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{Recorder, RecordingFile};

    /// A link that waits for CTS and whose chip counts errors: after each exchange the next of these.
    struct Line(std::vec::IntoIter<LineErrors>, LineErrors);

    impl Link for Line {
        fn exchange(
            &mut self,
            outgoing: &[u8],
            incoming: &mut Vec<u8>,
            _: Duration,
        ) -> Result<usize, LinkError> {
            self.1 = self.0.next().unwrap();
            incoming.extend_from_slice(b"answer");
            Ok(outgoing.len())
        }

        fn now(&self) -> Duration {
            Duration::from_millis(1)
        }

        fn bytes_per_second(&self) -> Option<f64> {
            None
        }

        fn waits_for_cts(&self) -> bool {
            true
        }

        fn name(&self) -> String {
            "a line".to_owned()
        }

        fn line_errors(&self) -> LineErrors {
            self.1
        }
    }

    #[test]
    fn a_replay_tells_of_the_line_what_the_recorded_link_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.rec");
        let framing = LineErrors { framing: 2, ..LineErrors::default() };
        let all = LineErrors { overrun: 1, parity: 3, framing: 2, breaks: u64::MAX };
        let seen = [LineErrors::default(), framing, framing, all];
        let line = Line(Vec::from(seen).into_iter(), LineErrors::default());
        let file = RecordingFile::prepare(&path, false).unwrap();
        let mut recorder = Recorder::begin(Box::new(line), file, &()).unwrap();
        for _ in seen {
            recorder.exchange(b"request", &mut Vec::new(), Duration::ZERO).unwrap();
        }
        drop(recorder);
        let recording = Recording::read(&path).unwrap();
        assert_eq!(recording.sent().collect::<Vec<_>>(), [b"request"; 4]);
        let mut replay = ReplayLink::new(recording).unwrap();
        assert!(replay.waits_for_cts());
        for errors in seen {
            let mut incoming = Vec::new();
            assert_eq!(replay.exchange(b"request", &mut incoming, Duration::ZERO).unwrap(), 7);
            assert_eq!((incoming.as_slice(), replay.line_errors()), (b"answer".as_slice(), errors));
        }
        // A recording may hold any counts.
        let mut twice = replay.line_errors();
        twice += replay.line_errors();
        assert_eq!((twice.breaks, twice.parity, twice.sum()), (u64::MAX, 6, u64::MAX));
        let ended = replay.exchange(b"request", &mut Vec::new(), Duration::ZERO);
        let Err(ended @ LinkError::RecordingEnds { .. }) = ended else { panic!("{ended:?}") };
        // Whoever recorded it may not have interrupted it.
        assert!(ended.to_string().contains("lost its link"), "{ended}");
    }

    #[test]
    fn a_recording_that_knows_nothing_of_the_line_is_replayed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.rec");
        let head = br#"{"link":"a line","bytes_per_second":1000.0,"run":null}"#;
        // At 1 ms, 2 bytes sent and 3 received.
        let exchange = b"\x40\x42\x0f\0\0\0\0\0\x02\0\0\0\x03\0\0\0heard";
        fs::write(&path, [b"halfrow recording 1\n", &head[..], b"\n", exchange].concat()).unwrap();
        let mut replay = ReplayLink::new(Recording::read(&path).unwrap()).unwrap();
        assert_eq!((replay.waits_for_cts(), replay.bytes_per_second()), (false, Some(1000.0)));
        let mut incoming = Vec::new();
        assert_eq!(replay.exchange(b"he", &mut incoming, Duration::ZERO).unwrap(), 2);
        assert_eq!((incoming.as_slice(), replay.now()), (b"ard".as_slice(), Duration::from_millis(1)));
        assert_eq!(replay.line_errors(), LineErrors::default());
    }
}
