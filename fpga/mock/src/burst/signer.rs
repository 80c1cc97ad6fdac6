//! The outputs of a burst: signed row by row, and counted frame by frame.

use std::collections::VecDeque;

use halfrow_protocol::message::{BurstMode, FrameRecord};

use super::defects::{BurstDefects, Wear};
use super::trap::Trap;
use crate::core::Leaving;

/// A row that has not left completely yet.
#[derive(Debug)]
pub(super) struct RowInside {
    /// The pixel clock of its first sample.
    pub(super) first_in: u64,
    /// The pixel clock of its last sample.
    pub(super) last_in: u64,
    /// Its number in the frame.
    pub(super) row: u16,
    /// Its samples.
    pub(super) width: u16,
    /// Whether another row entered before it.
    pub(super) follows: bool,
    /// Whether it is the last of its frame.
    pub(super) ends_frame: bool,
}

/// A frame that has not left completely yet.
#[derive(Debug)]
struct FrameInside {
    number: u32,
    hasher: crc32fast::Hasher,
    record: FrameRecord,
}

/// Signs the outputs.
#[derive(Debug)]
pub(super) struct Signer {
    rows: VecDeque<RowInside>,
    frames: VecDeque<FrameInside>,
    /// The outputs of the row that is leaving, in the form in which they are signed: W of them, of which the first `left` have
    /// left.
    outputs: Vec<[u8; 2]>,
    left: usize,
    /// The value of `left` at which there is something to do: after the first output, or after all.
    edge: usize,
    lost_row: Option<u16>,
    wear: Wear,
    /// The trap, which sees every signature.
    pub(super) trap: Trap,
    /// The records of the frames that have left.
    pub(super) records: VecDeque<FrameRecord>,
}

impl Signer {
    pub(super) fn new(max_height: u16, defects: BurstDefects, lost_row: Option<u16>) -> Self {
        Self {
            rows: VecDeque::new(),
            frames: VecDeque::new(),
            outputs: Vec::new(),
            left: 0,
            edge: 1,
            lost_row,
            wear: Wear::new(defects),
            trap: Trap::new(max_height),
            records: VecDeque::new(),
        }
    }

    /// Starts a burst.
    pub(super) fn start(&mut self, mode: BurstMode) {
        self.records.clear();
        self.trap.is_set = mode == BurstMode::Trapped;
        if self.trap.is_set {
            self.trap.kept = None;
        }
    }

    /// Forgets everything inside, so that nothing more leaves, and empties the trap.
    pub(super) fn drop_inside(&mut self) {
        self.rows.clear();
        self.frames.clear();
        self.outputs.clear();
        (self.left, self.edge) = (0, 1);
        self.trap.kept = None;
    }

    /// Begins frame `number` of the burst.
    pub(super) fn begin_frame(&mut self, number: u32, held_back: bool) {
        let record = FrameRecord { held_back, ..FrameRecord::default() };
        self.frames.push_back(FrameInside { number, hasher: crc32fast::Hasher::new(), record });
    }

    /// A row of the newest frame enters, made with tables of this generation.
    pub(super) fn enter(&mut self, row: RowInside, generation: u8) {
        if let Some(frame) = self.frames.back_mut() {
            frame.record.generation = generation;
        }
        self.outputs.resize(row.width.into(), [0; 2]);
        self.rows.push_back(row);
    }

    /// Takes an output that left at the pixel clock `now`.
    #[inline]
    pub(super) fn collect(&mut self, leaving: Leaving, now: u64) {
        let mut sample = leaving.sample;
        if self.wear.spoils() {
            sample = self.spoil(sample);
        }
        // Only rows that have entered leave, and all have the same width.
        let Some(output) = self.outputs.get_mut(self.left) else { return };
        *output = sample.to_le_bytes();
        self.left += 1;
        if self.left == self.edge {
            self.row_edge(now);
        }
    }

    #[cold]
    fn spoil(&mut self, sample: u16) -> u16 {
        self.rows.front().map_or(sample, |row| self.wear.spoil(row, self.left == 0, sample))
    }

    /// Handles the first or the last output of a row.
    #[cold]
    fn row_edge(&mut self, now: u64) {
        let (Some(row), Some(frame)) = (self.rows.front(), self.frames.front_mut()) else { return };
        let is_first = self.left == 1;
        let is_lost = self.lost_row == Some(row.row);
        if !is_lost {
            let latency =
                if is_first { now - row.first_in } else { now - row.last_in + self.wear.late_by(row.row) };
            frame.measure(u16::try_from(latency).unwrap_or(u16::MAX));
        }
        if is_first {
            self.edge = self.outputs.len();
            return;
        }
        if !is_lost {
            let signature = crc32fast::hash(self.outputs.as_flattened());
            self.trap.look(frame.number, frame.record.rows, signature, &self.outputs);
            frame.sign(signature, row.width);
        }
        if row.ends_frame {
            self.end_frame();
        }
        self.rows.pop_front();
        (self.left, self.edge) = (0, 1);
    }

    fn end_frame(&mut self) {
        if let Some(FrameInside { hasher, mut record, .. }) = self.frames.pop_front() {
            record.signature = hasher.finalize();
            self.records.push_back(record);
            self.wear.count_frame();
        }
    }
}

impl FrameInside {
    fn measure(&mut self, latency: u16) {
        let FrameRecord { least_latency, most_latency, .. } = &mut self.record;
        *least_latency = if *least_latency == 0 { latency } else { latency.min(*least_latency) };
        *most_latency = latency.max(*most_latency);
    }

    /// Adds a row with this signature to the frame.
    fn sign(&mut self, signature: u32, width: u16) {
        self.hasher.update(&signature.to_le_bytes());
        self.record.rows = self.record.rows.saturating_add(1);
        self.record.samples = self.record.samples.saturating_add(width.into());
    }
}
