//! The Verilog judged by the mock: both get the same bytes and must say the same.

use std::time::Duration;

use halfrow_mock::Options;
use halfrow_pipe::Endpoint;
use halfrow_protocol::{Decoder, Header, Kind};
use halfrow_sim::{Board, Failure};

/// The offset of the four bytes of build in the reply to HELLO (WIRE.md).
const BUILD_AT: usize = 10;

/// A board, and a mock of the same build.
pub(crate) struct Judged {
    board: Board,
    judge: halfrow_mock::Board,
    outgoing: Vec<u8>,
}

impl Judged {
    pub(crate) fn new(board: Board, options: &Options) -> Self {
        let mut judge = halfrow_mock::Board::new(options, None).unwrap();
        judge.go_on_to_rest();
        Self { board, judge, outgoing: Vec::new() }
    }
}

impl Endpoint for Judged {
    type Failure = Failure;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Failure> {
        self.board.receive(bytes, now)?;
        self.judge.receive(bytes, now);
        let said = std::mem::take(self.board.outgoing());
        compare(&packets(&said), &packets(self.judge.outgoing()));
        self.judge.outgoing().clear();
        self.outgoing.extend(said);
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.outgoing
    }
}

/// Both must have sent the same packets in the same order. When a row leaves the Verilog while the next one enters, its window
/// is smaller by that row than the mock's, whose rows enter in an instant.
fn compare(said: &[(Header, Vec<u8>)], expected: &[(Header, Vec<u8>)]) {
    let headers = |packets: &[(Header, Vec<u8>)]| packets.iter().map(|it| it.0).collect::<Vec<_>>();
    assert_eq!(said.len(), expected.len(), "{:?}, expected {:?}", headers(said), headers(expected));
    for ((header, payload), (expected_header, expected_payload)) in said.iter().zip(expected) {
        let is_entering = header.kind == Kind::RowOut.code()
            && header.window.checked_add(1) == Some(expected_header.window);
        let window = if is_entering { header.window } else { expected_header.window };
        assert_eq!(header, &Header { window, ..*expected_header });
        assert_eq!(payload, expected_payload, "of {header:?}");
    }
}

/// The packets in these bytes, without what a board says about itself.
fn packets(mut wire: &[u8]) -> Vec<(Header, Vec<u8>)> {
    let (mut decoder, mut packets) = (Decoder::new(), Vec::new());
    while let Some(packet) = decoder.next(&mut wire) {
        let packet = packet.unwrap();
        let mut payload = packet.payload.to_vec();
        match packet.header.kind {
            kind if kind == Kind::Capabilities.code() => payload.clear(),
            kind if kind == Kind::Hello.code() => {
                payload.iter_mut().skip(BUILD_AT).take(4).for_each(|byte| *byte = 0);
            }
            _ => {}
        }
        packets.push((packet.header, payload));
    }
    packets
}
