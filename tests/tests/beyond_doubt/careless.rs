//! Boards that accept broken packets; and links that repair one on the way, which is no proof of such a board.

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

use super::by_the_rules::{broken, plan};

/// What a decoder does not check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unlooked {
    Crc,
    Version,
    Length,
}

/// The mock board with a decoder that leaves one check out.
#[derive(Debug)]
struct Careless {
    unlooked: Unlooked,
    /// How many broken packets it still accepts.
    takes: usize,
    board: Board,
    piece: Vec<u8>,
    encoder: Encoder,
}

impl Careless {
    /// The packet with the CRC, version and length that it should have, if nothing else is wrong with it.
    fn taken(&mut self) -> Vec<u8> {
        let piece = mem::take(&mut self.piece);
        let bytes = unstuffed(&piece);
        let mut wire = Vec::new();
        if let [version, kind, s0, s1, l0, l1, 0, session, w0, w1, w2, w3, rest @ ..] = bytes.as_slice()
            && let Some((packet, told)) = bytes.split_last_chunk()
            && rest.len() >= 4
            && (*version == 1 || self.unlooked == Unlooked::Version)
            && (rest.len() == usize::from(u16::from_le_bytes([*l0, *l1])) + 4
                || self.unlooked == Unlooked::Length)
            && (u32::from_le_bytes(*told) == crc(packet) || self.unlooked == Unlooked::Crc)
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
}

/// The bytes that are stuffed into `piece` (WIRE.md, 1).
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

/// CRC-32 (WIRE.md, 1).
fn crc(bytes: &[u8]) -> u32 {
    let bit = |crc: u32, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), bit))
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

/// The report on a board that accepts `takes` broken packets.
fn report(unlooked: Unlooked, takes: usize) -> Report {
    let board = Board::new(&Options::default(), None).unwrap();
    let careless = Careless { unlooked, takes, board, piece: Vec::new(), encoder: Encoder::new() };
    let link = WireLink::new(Pipe::new(careless, PipeOptions::default(), None), "a careless board", false);
    judge_by_plan(&plan(), Candidate::new("careless", BoardKind::Mock, link))
}

#[test]
fn a_board_that_takes_damaged_packets_fails() {
    for unlooked in [Unlooked::Crc, Unlooked::Version, Unlooked::Length] {
        let report = report(unlooked, usize::MAX);
        assert_eq!(broken(&report).0, Rule::Damage, "{unlooked:?}: {}", report.headline());
    }
}

/// The link flips back the very bit that was wrong, so that the packet is whole again.
#[test]
fn a_damaged_packet_that_a_link_makes_whole_again_makes_no_sound_board_fail() {
    for takes in 1..=2 {
        let report = report(Unlooked::Crc, takes);
        assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    }
}
