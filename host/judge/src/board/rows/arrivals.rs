//! Rows on their way back, in whatever order and number a link delivers them.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::time::Duration;

use halfrow_protocol::message::{RefusalCode, Reply, RowOut};
use halfrow_protocol::{Kind, Packet, samples};

use super::in_flight::InFlight;
use super::numbers::Numbers;
use super::{ReturnedRow, RowTraffic};
use crate::board::BoardError;

pub(super) struct Arrivals<'a> {
    pub(super) traffic: &'a mut dyn RowTraffic,
    pub(super) in_flight: InFlight,
    /// The oldest row that has not come back.
    pub(super) missing: u32,
    /// Rows that came back before an earlier one.
    ahead: BTreeSet<u32>,
    /// Whether a row came while an earlier one is still missing.
    pub(super) gap: bool,
    /// Rows that came although they had come before.
    pub(super) copies: Vec<u32>,
    /// Refusals of rows that do not belong to the stream.
    pub(super) old_refusals: u64,
    pub(super) numbers: Numbers,
    unpacked: Vec<u16>,
    pub(super) flow: ControlFlow<()>,
}

impl<'a> Arrivals<'a> {
    pub(super) fn new(traffic: &'a mut dyn RowTraffic, first_row: u32, numbers: Numbers) -> Self {
        Self {
            traffic,
            in_flight: InFlight::new(first_row),
            missing: first_row,
            ahead: BTreeSet::new(),
            gap: false,
            copies: Vec::new(),
            old_refusals: 0,
            numbers,
            unpacked: Vec::new(),
            flow: ControlFlow::Continue(()),
        }
    }

    /// How many rows came back before an earlier one.
    pub(super) fn ahead(&self) -> u32 {
        self.ahead.len() as u32
    }

    /// Takes rows and refusals of rows; ignores other packets.
    pub(super) fn take(&mut self, packet: &Packet<'_>) -> Result<(), BoardError> {
        if ![Kind::RowOut.code(), Kind::Refusal.code()].contains(&packet.header.kind) {
            return Ok(());
        }
        let reply = match (Reply::read(packet), RowOut::place_of(packet)) {
            (Ok(reply), _) => reply,
            // A repeat that waited while CONFIGURE came may leave with the length of the rows after it.
            (Err(_), Some(place)) if place.row_sequence < self.missing => {
                self.copies.push(place.row_sequence);
                return Ok(());
            }
            (Err(source), _) => return Err(BoardError::Malformed { kind: Kind::RowIn, source }),
        };
        match reply {
            Reply::RowOut(row) => self.take_row(&row),
            Reply::Refusal(refusal) if refusal.code == RefusalCode::Session => {
                Err(BoardError::SessionLost { silent: Duration::ZERO })
            }
            Reply::Refusal(refusal) if refusal.kind == Kind::RowIn.code() => {
                if !self.numbers.has(packet.header.sequence) {
                    self.old_refusals += 1;
                    return Ok(());
                }
                Err(BoardError::Refused { kind: Kind::RowIn, refusal })
            }
            _ => Ok(()),
        }
    }

    fn take_row(&mut self, found: &RowOut<'_>) -> Result<(), BoardError> {
        let row_sequence = found.place.row_sequence;
        if row_sequence < self.missing || self.ahead.contains(&row_sequence) {
            self.copies.push(row_sequence);
            return Ok(());
        }
        let Some(row) = self.in_flight.row(row_sequence) else { return Ok(()) };
        if self.flow.is_break() {
            return Ok(());
        }
        if found.place != row.place {
            return Err(BoardError::WrongPlace { place: found.place });
        }
        self.ahead.insert(row_sequence);
        self.unpacked.resize(row.frame.width(), 0);
        samples::unpack(found.packed, &mut self.unpacked);
        self.flow = self.traffic.returned(&ReturnedRow {
            frame: row.place.frame,
            row: row.index,
            generation: found.generation,
            first_latency: found.first_latency,
            last_latency: found.last_latency,
            pauses: found.pauses,
            repeats: found.repeats,
            entered: found.entered,
            samples: &self.unpacked,
        });
        while self.ahead.remove(&self.missing) {
            self.missing += 1;
        }
        self.gap = !self.ahead.is_empty();
        self.in_flight.forget_before(self.missing);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use halfrow_protocol::Header;

    use super::super::{Given, Unjudged};
    use super::*;

    /// A packet of the row `row_sequence`, 64 samples wide by its place, that carries those of a narrower row.
    fn cut(row_sequence: u8) -> Vec<u8> {
        let place = [row_sequence, 0, 0, 0, 0, 0, row_sequence, 0, 64, 0, 0, 1];
        place.into_iter().chain(iter::repeat_n(0, 20)).collect()
    }

    #[test]
    fn a_row_that_came_before_may_come_again_with_another_length() {
        let mut traffic = Unjudged(iter::empty());
        let mut arrivals = Arrivals::new(&mut traffic, 5, Numbers::new(Given::default(), 0));
        let mut take = |row_sequence: u8| {
            let header =
                Header { kind: Kind::RowOut.code(), sequence: 0, reply: false, session: 1, window: 0 };
            arrivals.take(&Packet { header, payload: &cut(row_sequence) })
        };
        assert!(take(4).is_ok());
        assert!(matches!(take(5), Err(BoardError::Malformed { .. })));
        assert_eq!(arrivals.copies, [4]);
    }
}
