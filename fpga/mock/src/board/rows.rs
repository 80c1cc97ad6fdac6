//! Rows: credit, order, and sending again what was lost.

use std::collections::BTreeMap;

use halfrow_protocol::message::{RefusalCode, Reply, RowIn, RowOut, RowPlace, Status};
use halfrow_protocol::{Header, Kind, samples};

use super::{Board, Refused, count};
use crate::faults::{Conduct, Misread};
use crate::player;

/// Rows that wait to be played, and the row sequence numbers from which credit and acknowledgements follow.
#[derive(Debug)]
pub(super) struct RowBanks {
    banks: u8,
    waiting: BTreeMap<u32, (RowPlace, Vec<u16>)>,
    next_to_play: u32,
    acknowledged: u32,
    /// The first row that has never been sent back.
    unsent: u32,
    /// How often each row in an out-bank was sent again.
    repeats: BTreeMap<u32, u16>,
    /// ROW_OUT packets sent in this session.
    packets: u16,
    last_played: Option<RowPlace>,
}

impl RowBanks {
    pub(super) fn new(banks: u8) -> Self {
        Self {
            banks,
            waiting: BTreeMap::new(),
            next_to_play: 0,
            acknowledged: 0,
            unsent: 0,
            repeats: BTreeMap::new(),
            packets: 0,
            last_played: None,
        }
    }

    /// The same banks in the same session, emptied and waiting for `next_row`, after `packets` ROW_OUT packets.
    pub(super) fn restarted(&self, next_row: u32, packets: u16) -> Self {
        Self {
            next_to_play: next_row,
            acknowledged: next_row,
            unsent: next_row,
            packets,
            ..Self::new(self.banks)
        }
    }

    /// ROW_OUT packets sent in this session.
    pub(super) fn packets(&self) -> u16 {
        self.packets
    }

    /// The row sequence number before which the host may send.
    pub(super) fn credit(&self) -> u32 {
        self.next_to_play.saturating_add(self.banks.into())
    }

    pub(super) fn acknowledged(&self) -> u32 {
        self.acknowledged
    }

    /// Notes that the host has every row before `window`.
    fn acknowledge(&mut self, window: u32) {
        self.acknowledged = self.acknowledged.max(window);
    }

    pub(super) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The first row that has not arrived.
    pub(super) fn next_row_in(&self) -> u32 {
        (self.next_to_play..=u32::MAX).find(|row| !self.waiting.contains_key(row)).unwrap_or(u32::MAX)
    }

    /// The place of the row before `row_sequence`, if it is known.
    fn predecessor(&self, row_sequence: u32) -> Option<RowPlace> {
        let before = row_sequence.checked_sub(1)?;
        let waiting = self.waiting.get(&before).map(|(place, _)| *place);
        waiting.or(self.last_played.filter(|place| place.row_sequence == before))
    }
}

impl Board {
    /// The window in a packet to the host.
    pub(super) fn window(&self) -> u32 {
        let credit = self.rows.credit();
        if self.has(Conduct::ShortWindow) { credit & u32::from(u16::MAX) } else { credit }
    }

    /// Takes a row into its bank, or handles one that was sent again.
    pub(super) fn row_in(&mut self, row: &RowIn<'_>) -> Result<(), Refused> {
        if self.bursts.is_under_way() {
            return Err((RefusalCode::Busy, 0));
        }
        let place = row.place;
        if place.row_sequence < self.rows.next_to_play || self.rows.waiting.contains_key(&place.row_sequence)
        {
            self.row_again(place.row_sequence);
            return Ok(());
        }
        if place.row_sequence >= self.rows.credit() {
            return Err((RefusalCode::Credit, 0));
        }
        self.check_place(&place)?;
        let mut unpacked = vec![0; usize::from(place.width)];
        samples::unpack(row.packed, &mut unpacked);
        let largest = self.player.settings().depth.largest();
        let over = unpacked.iter().filter(|&&sample| sample > largest).count();
        self.status.samples_over =
            self.status.samples_over.saturating_add(u32::try_from(over).unwrap_or(u32::MAX));
        count(&mut self.status.rows_in);
        self.rows.waiting.insert(place.row_sequence, (place, unpacked));
        Ok(())
    }

    fn check_place(&self, place: &RowPlace) -> Result<(), Refused> {
        if !self.finds_tables(place) {
            return Err((RefusalCode::NotReady, 0));
        }
        let settings = self.player.settings();
        let fits = place.width == settings.width
            && place.row < settings.height
            && place.last == (place.row == settings.height - 1);
        if fits && (self.follows(place) || self.has(Conduct::RowsAnywhere)) {
            Ok(())
        } else {
            Err((RefusalCode::Row, 0))
        }
    }

    /// Whether there will be committed tables when the row enters; without a configuration there are none. While an earlier row
    /// is missing, that row may be the one that a pending commit waits for.
    fn finds_tables(&self, place: &RowPlace) -> bool {
        let is_next = place.row_sequence == self.rows.next_to_play;
        self.tables.are_ready_for(place.frame) || !is_next && self.tables.has_commit()
    }

    /// Whether the row begins a frame or follows its predecessor. A predecessor that has not arrived may turn out to be the
    /// right one.
    fn follows(&self, place: &RowPlace) -> bool {
        let is_known = |before: &RowPlace| {
            before.row_sequence < self.rows.next_to_play || !self.has(Conduct::AnyFollower)
        };
        place.row == 0
            || match self.rows.predecessor(place.row_sequence).filter(is_known) {
                Some(before) => before.frame == place.frame && before.row == place.row - 1,
                None => place.row_sequence != self.rows.next_to_play,
            }
    }

    /// Handles a row that is known. If its result is in an out-bank, the host has not received it, and it is sent again.
    fn row_again(&mut self, row_sequence: u32) {
        if self.player.banks.first_from(row_sequence).is_some_and(|row| row.name.sequence == row_sequence) {
            count(&mut self.status.rows_repeated);
            let stands = self.has(Conduct::StuckRepeats);
            let repeats = self.rows.repeats.entry(row_sequence).or_default();
            *repeats = repeats.saturating_add(1);
            let told = if stands { 0 } else { *repeats };
            self.send_row(row_sequence, told);
        } else {
            count(&mut self.status.rows_unneeded);
        }
    }

    /// Frees the out-banks of all rows before `window`.
    pub(super) fn acknowledge(&mut self, window: u32) {
        // The host cannot have a row that was never sent.
        let sent = if self.has(Conduct::AckBeyond) { u32::MAX } else { self.rows.unsent };
        self.rows.acknowledge(window.min(sent));
        let acknowledged = self.rows.acknowledged;
        while self.player.banks.complete().next().is_some_and(|row| row.name.sequence < acknowledged) {
            self.player.banks.fetch();
        }
        self.rows.repeats.retain(|&row, _| row >= acknowledged);
    }

    /// Plays every row that has arrived and finds a free out-bank, in order.
    pub(super) fn play(&mut self) {
        while self.player.banks.has_room() {
            let Some((place, samples)) = self.rows.waiting.remove(&self.rows.next_to_play) else { break };
            let row = player::RowIn {
                sequence: place.row_sequence,
                frame: place.frame,
                row: place.row,
                last: place.last,
                samples,
            };
            // This cannot fail: the row was checked when it arrived, and a bank is free.
            if self.player.play(&row, &mut self.tables).is_err() {
                break;
            }
            self.rows.next_to_play += 1;
            self.rows.last_played = Some(place);
            self.send_complete();
        }
    }

    /// Brings the rest of a frame's last row out.
    pub(super) fn flush(&mut self) {
        self.player.flush();
        self.send_complete();
    }

    /// Sends the rows that have left the core since the last call.
    fn send_complete(&mut self) {
        while let Some(row) = self.player.banks.first_from(self.rows.unsent) {
            let sequence = row.name.sequence;
            let (first, last) = (u32::from(row.first_latency), u32::from(row.last_latency));
            let Status { rows_out, least_latency, most_latency, .. } = &mut self.status;
            count(rows_out);
            *least_latency = if *least_latency == 0 { first } else { first.min(*least_latency) }.min(last);
            *most_latency = first.max(last).max(*most_latency);
            self.rows.unsent = sequence + 1;
            self.send_row(sequence, 0);
        }
    }

    /// Sends a row that is in an out-bank.
    fn send_row(&mut self, sequence: u32, repeats: u16) {
        let Some(row) = self.player.banks.first_from(sequence) else { return };
        let settings = self.player.settings();
        let mut packed = Vec::with_capacity(samples::packed_length(row.samples.len()));
        samples::pack(&row.samples, &mut packed);
        if self.misreads(Misread::ReversedPairs) {
            packed.chunks_exact_mut(3).for_each(<[u8]>::reverse);
        }
        let out = RowOut {
            place: RowPlace {
                row_sequence: row.name.sequence,
                frame: row.name.frame,
                row: row.name.row,
                width: settings.width,
                last: row.name.row + 1 == settings.height,
            },
            generation: row.name.generation,
            first_latency: row.first_latency,
            last_latency: row.last_latency,
            pauses: row.pauses,
            repeats,
            packed: &packed,
            entered: self.options.entered.then_some(row.entered),
        };
        let header = Header {
            kind: Kind::RowOut.code(),
            sequence: self.rows.packets,
            reply: false,
            session: self.session.number(),
            window: self.window(),
        };
        self.rows.packets = self.rows.packets.wrapping_add(1);
        self.send(&header, &Reply::RowOut(out));
    }
}
