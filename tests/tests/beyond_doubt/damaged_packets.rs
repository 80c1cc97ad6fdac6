//! Packets that a link has damaged: a board that carries one out is wrong, and a link that makes one whole again no proof of it.

use std::convert::Infallible;
use std::mem;
use std::time::Duration;

use halfrow::link::{Candidate, WireLink};
use halfrow::result::{Report, Rule};
use halfrow::target::BoardKind;
use halfrow::verdict::Verdict;
use halfrow_mock::{Board, Options};
use halfrow_pipe::{Endpoint, Pipe, PipeOptions};
use halfrow_protocol::{Encoder, Header};
use halfrow_tests::system::judge_by_plan;

use crate::rules::{broken, plan};

/// The mock board behind a decoder that looks at no CRC.
#[derive(Debug)]
struct Careless {
    board: Board,
    /// So many damaged packets it takes, and no more.
    takes: usize,
    piece: Vec<u8>,
    encoder: Encoder,
}

impl Careless {
    /// The packet as it would be with the CRC that it should have, if its length is right.
    fn taken(&mut self) -> Vec<u8> {
        let piece = mem::take(&mut self.piece);
        let bytes = unstuffed(&piece);
        let mut wire = Vec::new();
        if let [1, kind, s0, s1, l0, l1, 0, session, w0, w1, w2, w3, rest @ ..] = bytes.as_slice()
            && rest.len() == usize::from(u16::from_le_bytes([*l0, *l1])) + 4
        {
            let header = Header {
                kind: *kind,
                sequence: u16::from_le_bytes([*s0, *s1]),
                reply: false,
                session: *session,
                window: u32::from_le_bytes([*w0, *w1, *w2, *w3]),
            };
            let payload = &rest[..rest.len() - 4];
            self.encoder.encode(&header, |wire| wire.extend_from_slice(payload), &mut wire).unwrap();
            if wire[1..wire.len() - 1] != piece {
                match self.takes.checked_sub(1) {
                    Some(left) => self.takes = left,
                    None => wire.clear(),
                }
            }
        }
        wire
    }

    /// The report on one that takes so many damaged packets.
    fn report(takes: usize) -> Report {
        let board = Board::new(&Options::default(), None).unwrap();
        let careless = Self { board, takes, piece: Vec::new(), encoder: Encoder::new() };
        let link =
            WireLink::new(Pipe::new(careless, PipeOptions::default(), None), "a careless board", false);
        judge_by_plan(&plan(), Candidate::new("careless", BoardKind::Mock, link))
    }
}

/// What was stuffed into `piece` (WIRE.md, 1).
fn unstuffed(piece: &[u8]) -> Vec<u8> {
    let (mut bytes, mut rest) = (Vec::new(), piece);
    while let [code, behind @ ..] = rest {
        let (block, next) = behind.split_at(behind.len().min(usize::from(*code) - 1));
        bytes.extend_from_slice(block);
        bytes.extend((*code < 255 && !next.is_empty()).then_some(0));
        rest = next;
    }
    bytes
}

impl Endpoint for Careless {
    type Failure = Infallible;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Infallible> {
        for &byte in bytes {
            if byte != 0 {
                self.piece.push(byte);
            } else if !self.piece.is_empty() {
                let wire = self.taken();
                self.board.receive(&wire, now);
            }
        }
        Ok(())
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        self.board.outgoing()
    }
}

#[test]
fn a_board_that_takes_damaged_packets_fails() {
    let report = Careless::report(usize::MAX);
    assert_eq!(broken(&report).0, Rule::Damage, "{}", report.headline());
}

/// The link flips the very bit back, so that the packet is whole again.
#[test]
fn a_damaged_packet_that_a_link_makes_whole_again_makes_no_sound_board_fail() {
    for takes in 1..=2 {
        let report = Careless::report(takes);
        assert_eq!(report.verdict, Verdict::Pass, "{}", report.headline());
    }
}
