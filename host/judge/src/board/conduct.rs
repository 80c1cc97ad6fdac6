//! What a board did that no link can have caused: every packet has a CRC, a session and a number of its own.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use halfrow_protocol::message::{Refusal, RowOut, RowPlace};
use halfrow_protocol::{Header, Kind, Packet, Reply};

use super::Response;

/// ROW_OUT packets that are remembered. One that a link held back for longer is not compared with others.
const PACKETS: usize = 256;
/// Rows whose first copy is remembered.
const ROWS: usize = 4096;

/// The board broke the protocol in a way that no link can cause.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Misconduct {
    /// A row came twice, and the copies differ.
    CopyDiffers {
        /// The row.
        place: RowPlace,
    },
    /// A row came that was never sent to the board.
    NeverSent {
        /// The row.
        place: RowPlace,
    },
    /// Two different ROW_OUT packets have the same number.
    NumberedTwice {
        /// The row of the second one.
        place: RowPlace,
        /// The number in both headers.
        number: u16,
    },
    /// A row was sent twice, by the board's own numbering of its packets, with the same count of repeats both times. The first of
    /// them may not have come.
    RepeatsStand {
        /// The row.
        place: RowPlace,
        /// The count of repeats in both.
        repeats: u16,
    },
    /// A `ROW_ACK` was answered.
    AckAnswered {
        /// By what.
        said: Response,
    },
    /// A row left the board after a later one, by the board's own numbering of its packets.
    OutOfOrder {
        /// The row that came too late.
        place: RowPlace,
    },
}

/// A received ROW_OUT packet.
struct Came {
    number: u16,
    place: RowPlace,
    repeats: u16,
    digest: u32,
}

/// Of the rows sent for the first time, the one with the greatest row sequence number.
struct Furthest {
    row_sequence: u32,
    /// The board's count of its packet. Unlike the number in the header it does not wrap.
    count: i64,
}

impl Furthest {
    /// The next one. Its packet's number is less than half the number range after this one's.
    fn then(&self, came: &Came) -> Self {
        let step = came.number.wrapping_sub(self.count as u16) as i16;
        Self { row_sequence: came.place.row_sequence, count: self.count + i64::from(step) }
    }
}

/// What the rows of a session have shown.
#[derive(Default)]
pub(super) struct Conduct {
    packets: VecDeque<Came>,
    /// A digest of each of the last rows, by row sequence number, without what may differ from copy to copy.
    rows: BTreeMap<u32, u32>,
    furthest: Option<Furthest>,
    came: u32,
    doubled: u32,
    /// The number of packets that must not be answered.
    damaged: Option<u16>,
    answer_to_damaged: Option<Response>,
    /// The last row that was refused, by the number of its packet.
    refused_row: Option<(u16, Refusal)>,
    misconduct: Option<Misconduct>,
}

impl Conduct {
    /// The first rule that the board broke.
    pub(super) fn misconduct(&self) -> Option<&Misconduct> {
        self.misconduct.as_ref()
    }

    /// A lower bound on the ROW_OUT packets that the board has sent in this session, by its own numbering.
    pub(super) fn packets_numbered(&self) -> u32 {
        let count = self.furthest.as_ref().map_or(0, |furthest| furthest.count + 1);
        u32::try_from(count.max(0)).unwrap_or(u32::MAX)
    }

    /// Packets of this number must not be answered.
    pub(super) fn await_answer(&mut self, number: u16) {
        (self.damaged, self.answer_to_damaged) = (Some(number), None);
    }

    /// The answer to them, if there was one.
    pub(super) fn answer_to_damaged(&self) -> Option<&Response> {
        self.answer_to_damaged.as_ref()
    }

    /// Copies of ROW_OUT packets that came.
    pub(super) fn doubled(&self) -> u32 {
        self.doubled
    }

    /// The ROW_OUT packets that came, without copies made by a link.
    pub(super) fn rows_came(&self) -> u32 {
        self.came
    }

    /// The refusal of the last refused row, if that row was sent in the packet `number`.
    pub(super) fn refused_row(&self, number: u16) -> Option<Refusal> {
        self.refused_row.filter(|refused| refused.0 == number).map(|refused| refused.1)
    }

    /// Notes a row that is further than all before it. A copy that a link held back for long is not: its number may have wrapped
    /// since.
    fn go_further(&mut self, came: &Came) {
        let row_sequence = came.place.row_sequence;
        let is_further = self.furthest.as_ref().is_none_or(|furthest| furthest.row_sequence < row_sequence);
        if came.repeats == 0 && is_further {
            let first = || Furthest { row_sequence, count: came.number.into() };
            self.furthest = Some(self.furthest.as_ref().map_or_else(first, |furthest| furthest.then(came)));
        }
    }

    /// Whether packets for all rows between those around `row_sequence` that came, `came` among them, are missing: then this row had
    /// left in its place, the link lost it, and what came is a repeat of it. After a RESET row sequence numbers go on after a gap, for
    /// which there is no room.
    fn had_room(&self, came: &Came, row_sequence: u32) -> bool {
        let sequence = |came: &&Came| came.place.row_sequence;
        let firsts = || self.packets.iter().chain([came]).filter(|came| came.repeats == 0);
        let below = firsts().filter(|came| sequence(came) < row_sequence).max_by_key(sequence);
        let above = firsts().filter(|came| sequence(came) > row_sequence).min_by_key(sequence);
        let late = firsts().rfind(|came| sequence(came) == row_sequence);
        let (Some(above), Some(late)) = (above, late) else { return false };
        let is_behind = (1..1 << 15).contains(&late.number.wrapping_sub(above.number));
        // The numbers of a session begin at 0.
        let (before, rows) = below.map_or((u16::MAX, above.place.row_sequence), |below| {
            (below.number, above.place.row_sequence - below.place.row_sequence - 1)
        });
        let after = |number: u16| number.wrapping_sub(before);
        let numbers = self.packets.iter().chain([came]).map(|came| after(came.number));
        let taken: BTreeSet<_> = numbers.filter(|number| (1..after(above.number)).contains(number)).collect();
        is_behind && u32::from(after(above.number)) > rows + taken.len() as u32
    }

    fn note(&mut self, misconduct: Misconduct) {
        self.misconduct.get_or_insert(misconduct);
    }

    /// Takes any packet, whatever session it names: no board may answer anybody's acknowledgement. Only the flag tells an empty answer
    /// from the host's own packet that a line echoes.
    pub(super) fn any_packet(&mut self, packet: &Packet<'_>) {
        let (ack, Header { kind, reply, .. }) = (Kind::RowAck.code(), packet.header);
        let is_answer = match Reply::read(packet) {
            Ok(Reply::Refusal(refusal)) => refusal.kind == ack,
            _ => reply && kind == ack,
        };
        if is_answer {
            self.note(Misconduct::AckAnswered { said: Response::of(packet) });
        }
    }

    /// Takes a row or the refusal of one; rows before `sent` have been sent.
    pub(super) fn packet(&mut self, packet: &Packet<'_>, sent: u32) {
        let Header { kind, sequence, .. } = packet.header;
        if kind != Kind::RowOut.code() && self.damaged == Some(sequence) {
            self.answer_to_damaged = Some(Response::of(packet));
        }
        if ![Kind::RowOut.code(), Kind::Refusal.code()].contains(&kind) {
            return;
        }
        match Reply::read(packet) {
            Ok(Reply::RowOut(row)) => self.row(sequence, &row, sent),
            Ok(Reply::Refusal(refusal)) if refusal.kind == Kind::RowIn.code() => {
                self.refused_row = Some((sequence, refusal));
            }
            _ => {}
        }
    }

    /// Takes a row from the packet that the board numbered `number`; rows before `sent` have been sent.
    fn row(&mut self, number: u16, row: &RowOut<'_>, sent: u32) {
        let place = row.place;
        if place.row_sequence >= sent {
            self.note(Misconduct::NeverSent { place });
        }
        let digest = digest(row);
        let came = Came { number, place, repeats: row.repeats, digest };
        if self.packets.iter().any(|earlier| earlier.is_another(&came)) {
            self.note(Misconduct::NumberedTwice { place, number });
        }
        if self.packets.iter().any(|earlier| earlier.repeats_as(&came)) {
            self.note(Misconduct::RepeatsStand { place, repeats: row.repeats });
        }
        let is_new = self.packets.iter().all(|earlier| earlier.number != number);
        self.came += u32::from(is_new);
        self.doubled += u32::from(!is_new);
        if let Some(place) = self.packets.iter().find_map(|earlier| earlier.misordered(&came)) {
            self.note(match self.had_room(&came, place.row_sequence) {
                true => Misconduct::RepeatsStand { place, repeats: 0 },
                false => Misconduct::OutOfOrder { place },
            });
        }
        if *self.rows.entry(place.row_sequence).or_insert(digest) != digest {
            self.note(Misconduct::CopyDiffers { place });
        }
        if self.rows.len() > ROWS {
            self.rows.pop_first();
        }
        if self.packets.len() == PACKETS {
            self.packets.pop_front();
        }
        self.go_further(&came);
        self.packets.push_back(came);
    }
}

impl Came {
    /// Whether two packets have the same number but are not one packet delivered twice.
    fn is_another(&self, other: &Self) -> bool {
        let same = (self.place.row_sequence, self.repeats, self.digest)
            == (other.place.row_sequence, other.repeats, other.digest);
        self.number == other.number && !same
    }

    /// Whether two packets of one row have the same count of repeats.
    fn repeats_as(&self, other: &Self) -> bool {
        self.place.row_sequence == other.place.row_sequence
            && self.number != other.number
            && self.repeats == other.repeats
            && self.repeats < u16::MAX
    }

    /// Of two rows that left for the first time in the wrong order, the place of the earlier row.
    fn misordered(&self, other: &Self) -> Option<RowPlace> {
        let [own, others] = [self, other].map(|came| came.place.row_sequence);
        if self.repeats > 0 || other.repeats > 0 || own == others {
            return None;
        }
        // Numbers wrap, but all packets that are compared lie close together.
        let numbered_before = other.number.wrapping_sub(self.number) < 1 << 15;
        let is_before = own < others;
        let earlier = if is_before { self.place } else { other.place };
        (self.number != other.number && numbered_before != is_before).then_some(earlier)
    }
}

/// Digest of everything that must be equal in every copy of a row.
fn digest(row: &RowOut<'_>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    let RowPlace { frame, row: index, width, last, .. } = row.place;
    for word in [frame, index, width, u16::from(last), u16::from(row.generation)] {
        hasher.update(&word.to_le_bytes());
    }
    for word in [row.first_latency, row.last_latency, row.pauses] {
        hasher.update(&word.to_le_bytes());
    }
    hasher.update(row.packed);
    hasher.finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(rows: &[(u16, u32, u16, u8)]) -> Option<Misconduct> {
        conduct(rows).misconduct().cloned()
    }

    fn conduct(rows: &[(u16, u32, u16, u8)]) -> Conduct {
        let mut conduct = Conduct::default();
        for &(number, row_sequence, repeats, sample) in rows {
            let place = RowPlace { row_sequence, frame: 0, row: row_sequence as u16, width: 2, last: false };
            let packed = &[sample, 0, 0];
            let (first_latency, last_latency, pauses, generation) = (44, 44, 0, 1);
            let row = RowOut {
                place,
                generation,
                first_latency,
                last_latency,
                pauses,
                repeats,
                packed,
                entered: None,
            };
            conduct.row(number, &row, 9);
        }
        conduct
    }

    #[test]
    fn a_copy_that_differs_in_its_place_or_its_measures_is_misconduct() {
        let place = RowPlace { row_sequence: 0, frame: 0, row: 0, width: 2, last: false };
        let first = RowOut {
            place,
            generation: 1,
            first_latency: 44,
            last_latency: 44,
            pauses: 0,
            repeats: 0,
            packed: &[1, 0, 0],
            entered: None,
        };
        let changes: [fn(&mut RowOut<'_>); 8] = [
            |row| row.place.frame += 1,
            |row| row.place.row += 1,
            |row| row.place.width += 2,
            |row| row.place.last = true,
            |row| row.generation += 1,
            |row| row.first_latency += 1,
            |row| row.last_latency += 1,
            |row| row.pauses += 1,
        ];
        for (which, change) in changes.into_iter().enumerate() {
            let mut copy = RowOut { repeats: 1, ..first };
            change(&mut copy);
            let mut conduct = Conduct::default();
            conduct.row(0, &first, 9);
            conduct.row(1, &copy, 9);
            let differs = Misconduct::CopyDiffers { place: copy.place };
            assert_eq!(conduct.misconduct(), Some(&differs), "change {which}");
        }
    }

    #[test]
    fn what_links_do_is_no_misconduct() {
        // Lost, doubled, overtaken, sent again, and with numbers that wrap.
        assert_eq!(found(&[(0, 0, 0, 1), (2, 2, 0, 3), (2, 2, 0, 3), (1, 1, 0, 2), (3, 0, 1, 1)]), None);
        assert_eq!(found(&[(3, 1, u16::MAX, 1), (2, 0, 1, 1)]), None);
        assert_eq!(found(&[(65_535, 7, 0, 1), (0, 8, 0, 1), (1, 7, 1, 1), (65_535, 7, 0, 1)]), None);
    }

    /// Numbers that other packets have are no room for a row that the link lost.
    #[test]
    fn a_repeat_that_does_not_count_is_told_from_a_row_in_another_place() {
        for stands in [&[(0, 0, 0, 1), (2, 2, 0, 1), (3, 1, 0, 1)][..], &[(1, 1, 0, 1), (2, 0, 0, 1)]] {
            assert!(matches!(found(stands), Some(Misconduct::RepeatsStand { .. })), "{stands:?}");
        }
        for reordered in [
            &[(0, 0, 0, 1), (1, 2, 0, 1), (2, 1, 0, 1)][..],
            &[(0, 0, 0, 1), (1, 0, 1, 1), (2, 2, 0, 1), (3, 1, 0, 1)],
            &[(4, 4, 0, 1), (6, 5, 1, 1), (7, 7, 0, 1), (8, 6, 0, 1)],
            &[(1, 2, 0, 1), (2, 1, 0, 1)],
        ] {
            assert!(matches!(found(reordered), Some(Misconduct::OutOfOrder { .. })), "{reordered:?}");
        }
    }

    #[test]
    fn packets_are_counted_by_their_numbers_whatever_a_link_does() {
        let count = |rows: &[_]| conduct(rows).packets_numbered();
        assert_eq!(count(&[]), 0);
        assert_eq!(count(&[(0, 0, 0, 1), (1, 1, 0, 1)]), 2);
        // Lost, doubled, late, and sent again.
        assert_eq!(count(&[(2, 2, 0, 1), (2, 2, 0, 1), (0, 0, 0, 1), (7, 3, 1, 1)]), 3);
        // Past the wrap of the numbers, with one packet held back from before it.
        let rows: Vec<_> =
            (0..70_000).map(|row| (row as u16, row, 0, 1)).chain([(65_000, 65_000, 0, 1)]).collect();
        assert_eq!(count(&rows), 70_000);
    }

    #[test]
    fn what_no_link_does_is() {
        let is =
            |rows: &[_], expected: fn(&Misconduct) -> bool| found(rows).is_some_and(|found| expected(&found));
        assert!(is(&[(0, 0, 0, 1), (1, 0, 1, 2)], |found| matches!(found, Misconduct::CopyDiffers { .. })));
        assert!(is(&[(0, 0, 0, 1), (0, 1, 0, 1)], |found| matches!(found, Misconduct::NumberedTwice { .. })));
        assert!(is(&[(0, 9, 0, 1)], |found| matches!(found, Misconduct::NeverSent { .. })));
        assert!(is(&[(0, 0, 0, 1), (1, 0, 0, 1)], |found| matches!(found, Misconduct::RepeatsStand { .. })));
        assert!(is(&[(5, 0, 2, 1), (4, 0, 2, 1)], |found| matches!(found, Misconduct::RepeatsStand { .. })));
    }

    /// Whichever of the two came first.
    #[test]
    fn of_two_rows_that_left_the_wrong_way_round_the_earlier_one_is_told() {
        for rows in [[(0, 1, 0, 1), (1, 0, 0, 1)], [(1, 0, 0, 1), (0, 1, 0, 1)]] {
            let place = RowPlace { row_sequence: 0, frame: 0, row: 0, width: 2, last: false };
            assert_eq!(found(&rows), Some(Misconduct::OutOfOrder { place }));
        }
    }
}
