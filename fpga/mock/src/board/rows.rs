//! Rows: credit, order, and sending again what got lost.

use std::collections::BTreeMap;

use halfrow_protocol::message::{RefusalCode, Reply, RowIn, RowOut, RowPlace};
use halfrow_protocol::{Header, Kind, samples};

use super::{Board, Refused, count};
use crate::player;

/// Rows that wait to be played, and the numbers that credit and acknowledgement are counted by.
#[derive(Debug)]
pub(super) struct RowBanks {
    banks: u32,
    waiting: BTreeMap<u32, (RowPlace, Vec<u16>)>,
    next_to_play: u32,
    acknowledged: u32,
    /// The first row that has never been sent back.
    unsent: u32,
    /// How often rows in the out-banks were sent again.
    repeats: BTreeMap<u32, u16>,
    /// ROW_OUT packets of the session.
    packets: u16,
    last_played: Option<RowPlace>,
}

impl RowBanks {
    pub(super) fn new(banks: u8) -> Self {
        Self {
            banks: banks.into(),
            waiting: BTreeMap::new(),
            next_to_play: 0,
            acknowledged: 0,
            unsent: 0,
            repeats: BTreeMap::new(),
            packets: 0,
            last_played: None,
        }
    }

    /// Forgets all rows, and waits for `next_row`.
    pub(super) fn restart(&mut self, next_row: u32) {
        *self = Self {
            next_to_play: next_row,
            acknowledged: next_row,
            unsent: next_row,
            packets: self.packets,
            ..Self::new(u8::try_from(self.banks).unwrap_or(u8::MAX))
        };
    }

    /// The row sequence number before which the host may send.
    pub(super) fn credit(&self) -> u32 {
        self.next_to_play.saturating_add(self.banks)
    }

    pub(super) fn acknowledged(&self) -> u32 {
        self.acknowledged
    }

    /// The host has every row before `window`. It cannot have one that was never sent.
    pub(super) fn acknowledge(&mut self, window: u32) {
        self.acknowledged = self.acknowledged.max(window.min(self.unsent));
    }

    pub(super) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The first row that has not arrived.
    pub(super) fn next_row_in(&self) -> u32 {
        (self.next_to_play..).find(|row| !self.waiting.contains_key(row)).unwrap_or(u32::MAX)
    }

    /// The row in front of `row_sequence`, as far as it is known.
    fn predecessor(&self, row_sequence: u32) -> Option<RowPlace> {
        let before = row_sequence.checked_sub(1)?;
        let waiting = self.waiting.get(&before).map(|(place, _)| *place);
        waiting.or(self.last_played.filter(|place| place.row_sequence == before))
    }
}

impl Board {
    /// Takes a row into its bank, or deals with one that came again.
    pub(super) fn row_in(&mut self, row: &RowIn<'_>) -> Result<(), Refused> {
        let place = row.place;
        if place.row_sequence < self.rows.next_to_play || self.rows.waiting.contains_key(&place.row_sequence) {
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
        let settings = self.player.settings();
        if !self.configured || place.row == 0 && !self.tables.are_ready_for(place.frame) {
            return Err((RefusalCode::NotReady, 0));
        }
        let fits = place.width == settings.width
            && place.row < settings.height
            && place.last == (place.row == settings.height - 1);
        let follows = self.rows.predecessor(place.row_sequence).is_none_or(|before| match place.row {
            0 => before.last,
            row => before.frame == place.frame && before.row == row - 1,
        });
        if fits && follows { Ok(()) } else { Err((RefusalCode::Row, 0)) }
    }

    /// A row that is known: if its result is in an out-bank, the host has not got it.
    fn row_again(&mut self, row_sequence: u32) {
        let complete = self.player.banks.complete().find(|row| row.name.sequence == row_sequence).cloned();
        match complete {
            Some(row) if row_sequence >= self.rows.acknowledged => {
                count(&mut self.status.rows_repeated);
                let repeats = self.rows.repeats.entry(row_sequence).or_default();
                *repeats = repeats.saturating_add(1);
                let repeats = *repeats;
                self.send_row(&row, repeats);
            }
            _ => count(&mut self.status.rows_unneeded),
        }
    }

    pub(super) fn free_acknowledged(&mut self) {
        let acknowledged = self.rows.acknowledged;
        while self.player.banks.complete().next().is_some_and(|row| row.name.sequence < acknowledged) {
            self.player.banks.fetch();
        }
        self.rows.repeats.retain(|&row, _| row >= acknowledged);
    }

    /// Plays every row that is there and has a free out-bank, in order.
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
            // The row was checked when it arrived, and a bank is free.
            if self.player.play(&row, &mut self.tables).is_err() {
                break;
            }
            self.rows.next_to_play += 1;
            self.rows.last_played = Some(place);
            self.send_complete();
        }
        self.player.flush();
        self.send_complete();
    }

    fn send_complete(&mut self) {
        let unsent = self.rows.unsent;
        let complete: Vec<_> =
            self.player.banks.complete().filter(|row| row.name.sequence >= unsent).cloned().collect();
        for row in complete {
            count(&mut self.status.rows_out);
            let (first, last) = (u32::from(row.first_latency), u32::from(row.last_latency));
            let least = &mut self.status.least_latency;
            *least = if *least == 0 { first } else { first.min(*least) }.min(last);
            self.status.most_latency = self.status.most_latency.max(first).max(last);
            self.rows.unsent = row.name.sequence + 1;
            self.send_row(&row, 0);
        }
    }

    fn send_row(&mut self, row: &crate::banks::RowOut, repeats: u16) {
        let mut packed = Vec::with_capacity(samples::packed_length(row.samples.len()));
        samples::pack(&row.samples, &mut packed);
        let place = RowPlace {
            row_sequence: row.name.sequence,
            frame: row.name.frame,
            row: row.name.row,
            width: self.player.settings().width,
            last: row.name.row + 1 == self.player.settings().height,
        };
        let header = Header {
            kind: Kind::RowOut.code(),
            sequence: self.rows.packets,
            reply: false,
            session: self.session.number(),
            window: self.rows.credit(),
        };
        self.rows.packets = self.rows.packets.wrapping_add(1);
        let out = RowOut {
            place,
            generation: row.name.generation,
            first_latency: row.first_latency,
            last_latency: row.last_latency,
            pauses: row.pauses,
            repeats,
            packed: &packed,
        };
        self.send(&header, &Reply::RowOut(out));
    }
}
