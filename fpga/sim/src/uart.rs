//! The other end of a UART at the board's pins. It heeds RTS, and never raises CTS: no board under simulation has to wait for its
//! host. `fpga/bench/halfrow_uart_bench.v` tries that.

use std::collections::VecDeque;
use std::path::Path;

use crate::board::Failure;
use crate::ffi::{self, Design, UartInputs, UartOutputs};
use crate::port::{Clocks, Port, Step};

/// Clocks a bit: 12 Mbaud at 96 MHz.
const DIVIDER: u32 = 8;

/// Bytes that still come after RTS was raised, as may happen with an FTDI chip.
const OVERRUN: u32 = 3;

/// A byte on its way over a line, bit by bit.
#[derive(Debug, Default)]
struct Sending {
    /// Levels to come, each for [`DIVIDER`] clocks.
    bits: VecDeque<bool>,
    clocks: u32,
}

impl Sending {
    fn is_idle(&self) -> bool {
        self.bits.is_empty() && self.clocks == 0
    }

    fn start(&mut self, byte: u8) {
        self.bits.push_back(false);
        self.bits.extend((0..8).map(|bit| byte >> bit & 1 == 1));
        self.bits.push_back(true);
    }

    /// The level for this clock.
    fn level(&mut self) -> bool {
        let level = self.bits.front().copied().unwrap_or(true);
        if !self.bits.is_empty() {
            self.clocks += 1;
            if self.clocks == DIVIDER {
                self.clocks = 0;
                self.bits.pop_front();
            }
        }
        level
    }
}

/// The receiver of a line.
#[derive(Debug, Default)]
struct Receiving {
    /// Clocks since the start bit began; none between bytes.
    clocks: Option<u32>,
    byte: u8,
}

impl Receiving {
    /// One clock with this level. Returns a byte in the middle of its stop bit.
    fn level(&mut self, level: bool) -> Option<u8> {
        let Some(clocks) = self.clocks else {
            self.clocks = (!level).then_some(0);
            return None;
        };
        let clocks = clocks + 1;
        self.clocks = Some(clocks);
        if clocks % DIVIDER != DIVIDER / 2 {
            return None;
        }
        match clocks / DIVIDER {
            // If the line is high again in the middle of the start bit, it was none.
            0 => self.clocks = self.clocks.filter(|_| !level),
            1..=8 => self.byte = self.byte >> 1 | u8::from(level) << 7,
            _ => {
                self.clocks = None;
                return level.then_some(self.byte);
            }
        }
        None
    }
}

/// `halfrow_uart_bridge` and the chip at its pins.
pub(crate) struct Uart {
    design: Design<UartInputs, UartOutputs>,
    clocks: Clocks,
    to_board: Sending,
    from_board: Receiving,
    /// Bytes that may still be sent although the board has raised RTS.
    overrun: u32,
    rxd: bool,
    /// Milliseconds that the core has not been told of yet.
    milliseconds: u64,
}

impl Uart {
    pub(crate) fn new(seed: u32) -> Self {
        Self {
            design: Design::new(&ffi::halfrow_uart, seed),
            clocks: Clocks::new(),
            to_board: Sending::default(),
            from_board: Receiving::default(),
            overrun: OVERRUN,
            rxd: true,
            milliseconds: 0,
        }
    }

    /// One clock of the link at the far end.
    fn far_end(&mut self, outputs: UartOutputs, offered: Option<u8>, step: &mut Step) {
        step.sent = self.from_board.level(outputs.txd);
        if let Some(byte) = offered.filter(|_| self.to_board.is_idle()) {
            step.taken = !outputs.rts_n || self.overrun > 0;
            self.overrun = if outputs.rts_n { self.overrun.saturating_sub(1) } else { OVERRUN };
            if step.taken {
                self.to_board.start(byte);
            }
        }
        self.rxd = self.to_board.level();
    }
}

impl Port for Uart {
    /// Three bytes may wait between the bridge and the line, each 80 clocks long.
    const REST: u32 = 1000;

    fn step(&mut self, offered: Option<u8>, millisecond: bool) -> Result<Step, Failure> {
        self.milliseconds += u64::from(millisecond);
        let edge = self.clocks.next();
        let inputs = UartInputs {
            link_edge: edge.link,
            core_edge: edge.core,
            rst: false,
            rxd: self.rxd,
            cts_n: false,
            millisecond: self.milliseconds > 0,
        };
        let outputs = self.design.clock(&inputs);
        self.milliseconds = self.milliseconds.saturating_sub(edge.core.into());
        let mut step = Step::default();
        if edge.link {
            self.far_end(outputs, offered, &mut step);
        }
        let lines_idle = self.to_board.is_idle() && self.from_board.clocks.is_none();
        step.quiet = offered.is_none() && outputs.quiet && lines_idle && self.milliseconds == 0;
        Ok(step)
    }

    fn reset(&mut self) {
        let rst = UartInputs { rst: true, rxd: true, ..UartInputs::default() };
        for _ in 0..100 {
            let edge = self.clocks.next();
            self.design.clock(&UartInputs { link_edge: edge.link, core_edge: edge.core, ..rst });
        }
    }

    fn trace(&mut self, path: &Path) -> bool {
        self.design.trace(path)
    }

    fn is_traced(&mut self) -> bool {
        self.design.is_traced()
    }
}
