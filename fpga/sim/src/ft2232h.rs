//! An FT2232H as an asynchronous FIFO at the board's pins, with the times of its data sheet (version 2.x, section 4.4). It
//! checks what the design does at the pins.

use std::collections::VecDeque;
use std::path::Path;

use crate::board::Failure;
use crate::ffi::{self, Design, FifoInputs, FifoOutputs};
use crate::port::{Clocks, Port, Step};

/// Picoseconds in a nanosecond.
const NS: u64 = 1000;

/// The longest that the chip takes: RXF# and TXE# after RD# and WR#, and the data after RD#.
const ANSWER: u64 = 14 * NS;
/// The shortest time for which RXF# and TXE# stay high between two bytes.
const PAUSE: u64 = 49 * NS;
/// From the rise of RD# or WR# until RXF# or TXE# may be low again.
const PAUSE_OVER: u64 = ANSWER + PAUSE;
/// The shortest time for which RD# and WR# must be low.
const PULSE: u64 = 30 * NS;
/// The shortest time for which data must be stable before WR# falls, and after it has risen.
const SETUP: u64 = 5 * NS;
const HOLD: u64 = 5 * NS;
/// The shortest time for which SIWU# must be low.
const STROBE: u64 = 250 * NS;

/// Bytes that the chip collects for a USB packet: 512 less the two of its status. SIWU# makes it send fewer.
const PACKET: usize = 510;
/// Bytes that it holds for the board.
const BUFFER: usize = 512;

/// A level, and when it last changed.
#[derive(Clone, Copy, Debug)]
struct Line {
    high: bool,
    since: u64,
}

impl Line {
    /// Follows the pin. Returns how long the previous level lasted, if the level changed.
    fn follow(&mut self, high: bool, at: u64) -> Option<u64> {
        let lasted = at - self.since;
        (self.high != high).then(|| {
            *self = Self { high, since: at };
            lasted
        })
    }
}

/// The chip's side of the pins.
#[derive(Debug)]
struct Chip {
    /// Bytes from USB.
    to_board: VecDeque<u8>,
    /// Bytes that were written and not yet sent off.
    gathered: Vec<u8>,
    /// Bytes on their way over USB.
    sent: VecDeque<u8>,
    rd: Line,
    wr: Line,
    siwu: Line,
    /// The value that the board drives the data pins to, if it does, and since when.
    driven: Option<u8>,
    driven_since: u64,
    /// From when on the current byte is on the data pins; none while RD# is high.
    readable: Option<u64>,
    /// Whether a byte was ever read, or written: RXF# and TXE# react only to that.
    read: bool,
    written: bool,
    broken: Option<Failure>,
}

impl Chip {
    fn new() -> Self {
        let high = Line { high: true, since: 0 };
        Self {
            to_board: VecDeque::new(),
            gathered: Vec::new(),
            sent: VecDeque::new(),
            rd: high,
            wr: high,
            siwu: high,
            driven: None,
            driven_since: 0,
            readable: None,
            read: false,
            written: false,
            broken: None,
        }
    }

    fn rule(&mut self, holds: bool, rule: &'static str, picoseconds: u64) {
        if !holds && self.broken.is_none() {
            self.broken = Some(Failure::Rule { rule, picoseconds });
        }
    }

    /// RXF# at the time `at`: after a byte it goes high as late, and comes back as early, as the data sheet allows.
    fn rxf_n(&self, at: u64) -> bool {
        match at - self.rd.since {
            _ if !self.rd.high => false,
            0..ANSWER if self.read => false,
            ANSWER..PAUSE_OVER if self.read => true,
            _ => self.to_board.is_empty(),
        }
    }

    /// TXE# at the time `at`. USB always has room.
    fn txe_n(&self, at: u64) -> bool {
        self.written && self.wr.high && (ANSWER..PAUSE_OVER).contains(&(at - self.wr.since))
    }

    /// What is on the data pins: a byte, or garbage.
    fn data(&self, at: u64) -> u8 {
        match (self.readable, self.to_board.front()) {
            (Some(from), Some(&byte)) if at >= from => byte,
            _ => 0xa5 ^ at as u8,
        }
    }

    /// Takes the levels of the pins at the time `at`.
    fn follow(&mut self, pins: &FifoOutputs, at: u64) {
        let driven = pins.data_drive.then_some(pins.data);
        self.rule(driven.is_none() || pins.rd_n, "both sides drive the data while RD# is low", at);
        self.rule(pins.rd_n || pins.wr_n, "RD# and WR# are low together", at);
        self.follow_data(driven, at);
        self.follow_rd(pins.rd_n, at);
        let wr_n = pins.wr_n || !pins.control_drive;
        self.follow_wr(wr_n, at);
        let siwu_n = pins.siwu_n || !pins.control_drive;
        if let Some(lasted) = self.siwu.follow(siwu_n, at)
            && siwu_n
        {
            self.rule(lasted >= STROBE, "SIWU# was low for less than 250 ns", at);
            self.send_off();
        }
    }

    fn follow_data(&mut self, driven: Option<u8>, at: u64) {
        if driven != self.driven {
            (self.driven, self.driven_since) = (driven, at);
            let held = self.wr.high && (!self.written || at - self.wr.since >= HOLD);
            self.rule(held, "the data changed while WR# was low, or within 5 ns of its rise", at);
        }
    }

    fn follow_rd(&mut self, rd_n: bool, at: u64) {
        let Some(lasted) = self.rd.follow(rd_n, at) else { return };
        if rd_n {
            self.rule(lasted >= PULSE, "RD# was low for less than 30 ns", at);
            self.to_board.pop_front();
            self.readable = None;
            self.read = true;
        } else {
            let offered = !self.to_board.is_empty() && (!self.read || lasted >= PAUSE_OVER);
            self.rule(offered, "RD# fell while RXF# was high", at);
            self.readable = Some(at + ANSWER);
        }
    }

    fn follow_wr(&mut self, wr_n: bool, at: u64) {
        let Some(lasted) = self.wr.follow(wr_n, at) else { return };
        if wr_n {
            self.rule(lasted >= PULSE, "WR# was low for less than 30 ns", at);
            self.written = true;
        } else {
            self.rule(!self.written || lasted >= PAUSE_OVER, "WR# fell while TXE# was high", at);
            let ready = self.driven.is_some() && at - self.driven_since >= SETUP;
            self.rule(ready, "the data did not stand 5 ns before WR# fell", at);
            self.gathered.extend(self.driven);
            if self.gathered.len() == PACKET {
                self.send_off();
            }
        }
    }

    fn send_off(&mut self) {
        self.sent.extend(self.gathered.drain(..));
    }
}

/// `halfrow_fifo_bridge` and the chip at its pins.
pub(crate) struct Ft2232h {
    design: Design<FifoInputs, FifoOutputs>,
    clocks: Clocks,
    chip: Chip,
    /// Milliseconds that the core has not been told of yet.
    milliseconds: u64,
}

impl Ft2232h {
    pub(crate) fn new(seed: u32) -> Self {
        let design = Design::new(&ffi::halfrow_fifo, seed);
        Self { design, clocks: Clocks::new(), chip: Chip::new(), milliseconds: 0 }
    }
}

impl Port for Ft2232h {
    /// SIWU# comes 200 clocks after the last byte.
    const REST: u32 = 1000;

    fn step(&mut self, offered: Option<u8>, millisecond: bool) -> Result<Step, Failure> {
        self.milliseconds += u64::from(millisecond);
        let edge = self.clocks.next();
        let inputs = FifoInputs {
            link_edge: edge.link,
            core_edge: edge.core,
            rst: false,
            rxf_n: self.chip.rxf_n(edge.at),
            txe_n: self.chip.txe_n(edge.at),
            data: self.chip.data(edge.at),
            millisecond: self.milliseconds > 0,
        };
        let outputs = self.design.clock(&inputs);
        self.milliseconds = self.milliseconds.saturating_sub(edge.core.into());
        let mut step = Step::default();
        if edge.link {
            self.chip.follow(&outputs, edge.at);
            step.sent = self.chip.sent.pop_front();
            step.taken = offered.is_some() && self.chip.to_board.len() < BUFFER;
            self.chip.to_board.extend(offered.filter(|_| step.taken));
        }
        let idle =
            self.chip.to_board.is_empty() && self.chip.gathered.is_empty() && self.chip.sent.is_empty();
        step.quiet = offered.is_none() && outputs.quiet && idle && self.milliseconds == 0;
        self.chip.broken.clone().map_or(Ok(step), Err)
    }

    fn reset(&mut self) {
        let rst = FifoInputs { rst: true, rxf_n: true, txe_n: true, ..FifoInputs::default() };
        for _ in 0..100 {
            let edge = self.clocks.next();
            self.design.clock(&FifoInputs { link_edge: edge.link, core_edge: edge.core, ..rst });
        }
    }

    fn trace(&mut self, path: &Path) -> bool {
        self.design.trace(path)
    }

    fn is_traced(&mut self) -> bool {
        self.design.is_traced()
    }
}
