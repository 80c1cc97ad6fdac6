//! The banks in which corrected rows are collected until they are fetched.

use std::collections::VecDeque;

use crate::core::Leaving;

/// Which row it is, and which tables made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowName {
    /// The row sequence number, which counts rows through all frames.
    pub sequence: u32,
    /// The frame's number.
    pub frame: u16,
    /// The row in its frame, from 0.
    pub row: u16,
    /// The generation of the tables that the row was bound to.
    pub generation: u8,
}

/// A corrected row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowOut {
    /// Which row it is.
    pub name: RowName,
    /// Its samples, W of them.
    pub samples: Vec<u16>,
    /// Pixel clocks from the first sample in to the first sample out.
    pub first_latency: u16,
    /// Pixel clocks from the last sample in to the last sample out.
    pub last_latency: u16,
    /// Board clocks that the pixel enable was off while the row entered, at most 65535.
    pub pauses: u16,
    /// CRC-32 of the samples that entered, words of 16 bits, little endian.
    pub entered: u32,
}

/// A row that has not left completely yet.
#[derive(Debug)]
struct Filling {
    row: RowOut,
    width: usize,
    first_in: u64,
    last_in: u64,
}

/// The out-banks. A row takes one when its first sample enters and keeps it until it is fetched.
#[derive(Debug)]
pub struct OutBanks {
    count: usize,
    filling: VecDeque<Filling>,
    full: VecDeque<RowOut>,
    lost_row: Option<u16>,
}

impl OutBanks {
    /// `count` free banks. A row with the number `lost_row` frees its bank by itself and is never returned.
    pub(crate) fn new(count: u8, lost_row: Option<u16>) -> Self {
        Self { count: count.into(), filling: VecDeque::new(), full: VecDeque::new(), lost_row }
    }

    /// Whether a bank is free for another row.
    #[must_use]
    pub fn has_room(&self) -> bool {
        self.filling.len() + self.full.len() < self.count
    }

    /// Whether all banks are free.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.filling.is_empty() && self.full.is_empty()
    }

    /// Whether no row is being collected, so that the core is empty.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.filling.is_empty()
    }

    /// Whether a row that was made with the tables of this generation is being collected.
    #[must_use]
    pub(crate) fn holds_generation(&self, generation: u8) -> bool {
        self.filling.iter().any(|filling| filling.row.name.generation == generation)
    }

    /// The complete rows, oldest first.
    pub fn complete(&self) -> impl Iterator<Item = &RowOut> {
        self.full.iter()
    }

    /// The oldest complete row with a sequence number of at least `sequence`.
    #[must_use]
    pub fn first_from(&self, sequence: u32) -> Option<&RowOut> {
        self.full.iter().find(|row| row.name.sequence >= sequence)
    }

    /// Takes the oldest complete row and frees its bank.
    pub fn fetch(&mut self) -> Option<RowOut> {
        self.full.pop_front()
    }

    /// Takes a bank for a row of `width` samples, the first of which enters at the pixel clock `now`.
    pub(crate) fn open(&mut self, name: RowName, width: usize, now: u64) {
        let samples = Vec::with_capacity(width);
        let row = RowOut { name, samples, first_latency: 0, last_latency: 0, pauses: 0, entered: 0 };
        self.filling.push_back(Filling { row, width, first_in: now, last_in: now });
    }

    /// Notes that the newest row's last sample entered at the pixel clock `now`, and the CRC-32 of all its samples.
    pub(crate) fn entered(&mut self, crc: u32, pauses: u16, now: u64) {
        if let Some(filling) = self.filling.back_mut() {
            filling.last_in = now;
            (filling.row.entered, filling.row.pauses) = (crc, pauses);
        }
    }

    /// Adds a sample that left at the pixel clock `now` to the oldest row that is being collected.
    pub(crate) fn collect(&mut self, leaving: Leaving, now: u64) {
        let Some(Filling { row, width, first_in, last_in }) = self.filling.front_mut() else { return };
        if row.samples.is_empty() {
            row.first_latency = clocks(*first_in, now);
        }
        row.samples.push(leaving.sample);
        if row.samples.len() == *width {
            row.last_latency = clocks(*last_in, now);
            self.finish();
        }
    }

    #[cold]
    fn finish(&mut self) {
        let lost_row = self.lost_row;
        let finished = self.filling.pop_front().map(|filling| filling.row);
        self.full.extend(finished.filter(|row| Some(row.name.row) != lost_row));
    }
}

/// Pixel clocks from `start` to `end`, at most 65535.
fn clocks(start: u64, end: u64) -> u16 {
    u16::try_from(end - start).unwrap_or(u16::MAX)
}
