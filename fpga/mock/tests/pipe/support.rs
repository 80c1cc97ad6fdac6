//! A host's side of the wire, as thin as possible.

use std::convert::Infallible;
use std::time::Duration;

use halfrow_mock::{Board, ConnectError, connect};
use halfrow_pipe::{Broken, Pipe, TargetError};
use halfrow_protocol::message::{Hello, Status};
use halfrow_protocol::{Decoder, Encoder, Header, Reply, Request};

/// Longer than anything takes on the wires of these tests.
pub(crate) const SILENCE: Duration = Duration::from_secs(10_000);

/// The session that a board opens first.
const SESSION: u8 = 1;

pub(crate) fn wire(options: &[(&str, &str)]) -> Pipe<Board> {
    connect(options).unwrap()
}

/// The error for options that describe no wire, and its text with all causes.
pub(crate) fn refusal(options: &[(&str, &str)]) -> (TargetError, String) {
    let ConnectError::Target(error) = connect(options).unwrap_err() else {
        panic!("{options:?} do not fit each other")
    };
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(&error);
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    (error, text)
}

/// A request as the host puts it on the wire.
pub(crate) fn packet(sequence: u16, request: &Request<'_>) -> Vec<u8> {
    let hello = matches!(request, Request::Hello(_));
    let session = if hello { 0 } else { SESSION };
    let header = Header { kind: request.kind().code(), sequence, session, ..Header::default() };
    let mut wire = Vec::new();
    Encoder::new().encode(&header, |payload| request.write(payload), &mut wire).unwrap();
    wire
}

/// The answer to ECHO from a board with four banks that has received no row.
pub(crate) fn echo_reply(sequence: u16, bytes: &[u8]) -> Vec<u8> {
    let reply = Reply::Echo(bytes);
    let kind = reply.kind().code();
    let header = Header { kind, sequence, reply: true, session: SESSION, window: 4 };
    let mut wire = Vec::new();
    Encoder::new().encode(&header, |payload| reply.write(payload), &mut wire).unwrap();
    wire
}

pub(crate) fn echo(sequence: u16, bytes: &[u8]) -> Vec<u8> {
    packet(sequence, &Request::Echo(bytes))
}

pub(crate) fn hello() -> Vec<u8> {
    let hello = Hello { nonce: 5, host: 6, version_min: 1, version_max: 1, take_over: false };
    packet(0, &Request::Hello(hello))
}

/// Sends `bytes` and listens until the wire is silent. Returns what came; on an error, what came before it.
pub(crate) fn talk(wire: &mut Pipe<Board>, bytes: &[u8]) -> (Vec<u8>, Result<(), Broken<Infallible>>) {
    let (mut rest, mut incoming) = (bytes, Vec::new());
    loop {
        let heard = incoming.len();
        match wire.exchange(rest, &mut incoming, SILENCE) {
            Ok(0) if incoming.len() == heard => {
                assert!(rest.is_empty(), "everything is taken in the end");
                return (incoming, Ok(()));
            }
            Ok(taken) => rest = &rest[taken..],
            Err(broken) => return (incoming, Err(broken)),
        }
    }
}

/// What comes back for `bytes` on a wire that does not break.
pub(crate) fn answer(wire: &mut Pipe<Board>, bytes: &[u8]) -> Vec<u8> {
    let (incoming, done) = talk(wire, bytes);
    done.unwrap();
    incoming
}

/// Sequence numbers of the undamaged packets in `bytes`.
pub(crate) fn sequences(mut bytes: &[u8]) -> Vec<u16> {
    let mut decoder = Decoder::new();
    let mut sequences = Vec::new();
    while let Some(packet) = decoder.next(&mut bytes) {
        sequences.extend(packet.ok().map(|packet| packet.header.sequence));
    }
    sequences
}

/// The board's counters.
pub(crate) fn status(wire: &mut Pipe<Board>) -> Status {
    let bytes = answer(wire, &packet(999, &Request::Status { clear: false }));
    let (mut decoder, mut rest) = (Decoder::new(), bytes.as_slice());
    let packet = decoder.next(&mut rest).unwrap().unwrap();
    let Reply::Status(status) = Reply::read(&packet).unwrap() else {
        unreachable!("STATUS is answered by STATUS")
    };
    status
}
