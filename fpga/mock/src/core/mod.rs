//! The corrector: samples in, corrected samples out half a row later, clock for clock as in hardware.

mod defects;
mod delay;
#[cfg(test)]
mod grid_tests;
mod kernel;
mod reader;
mod ring;
mod source;
mod values;
mod weights;
mod window;

use crate::faults::{BoardFault, Defects};
use crate::options::{OptionError, Options};

use delay::DelayLine;
use reader::Reader;
use ring::Ring;

pub(crate) use defects::{CoreDefects, DeadTap, StuckBits};
pub use delay::Leaving;
pub use kernel::{Kernel, NODES, Node, Weight};
pub use reader::RowBinding;
pub use values::{GridShape, RowValues, UNSTRETCHED};

/// Samples beyond half a row that must have entered before a column can be read; part of the latency L.
const LOOK_AHEAD: u32 = 3;

/// A sample that enters.
#[derive(Clone, Copy, Debug)]
pub struct Entering<'a> {
    /// The sample; its low 12 bits count.
    pub sample: u16,
    /// With the first sample of a row, what the row is bound to.
    pub begins: Option<&'a RowBinding>,
}

/// A row that has begun to enter and is not being read yet.
#[derive(Debug)]
struct Waiting {
    binding: RowBinding,
    base: usize,
    clocks: u32,
}

/// The datapath with its one ring of samples.
///
/// Inside a row every pixel clock must carry a sample; a source that pauses stops clocking the core. Between rows any
/// number of pixel clocks may pass without one. The sample of column j leaves W/2 + L pixel clocks after it entered.
#[derive(Debug)]
pub struct Core {
    ring: Ring,
    waiting: Option<Waiting>,
    leaving: Option<Reader>,
    delay: DelayLine,
    defects: CoreDefects,
    latency: u32,
}

impl Core {
    /// A core of the build `options`, empty, its ring all zero.
    ///
    /// # Errors
    /// If the options do not describe a build that can exist.
    pub fn new(options: &Options, fault: Option<BoardFault>) -> Result<Self, OptionError> {
        options.check()?;
        let defects = Defects::of(fault).core;
        let latency = u32::from(options.latency) + defects.extra_delay;
        Ok(Self {
            ring: Ring::new(options.ring_size().into(), defects.address_lines, defects.data_lines),
            waiting: None,
            leaving: None,
            delay: DelayLine::new((latency - LOOK_AHEAD) as usize),
            defects,
            latency,
        })
    }

    /// Pixel clocks D = W/2 + L between a sample and its output in rows of `width` columns, with the core's real latency.
    #[must_use]
    pub fn delay(&self, width: u16) -> u32 {
        u32::from(width) / 2 + self.latency
    }

    /// One pixel clock, with a sample or without one. Returns the output that is taken at the same clock edge.
    #[inline(always)]
    pub fn clock(&mut self, input: Option<Entering<'_>>) -> Option<Leaving> {
        if let Some(entering) = input {
            self.enter(entering);
        }
        self.begin_reading();
        let made = self.leaving.as_mut().and_then(|row| row.make(&self.ring, &self.defects));
        self.delay.step(made)
    }

    /// Writes a sample into the ring. A row's first sample also sets the time of the row's first read.
    #[inline]
    fn enter(&mut self, entering: Entering<'_>) {
        if let Some(binding) = entering.begins {
            let clocks = u32::from(binding.width) / 2 + LOOK_AHEAD;
            self.waiting = Some(Waiting { binding: binding.clone(), base: self.ring.next_address(), clocks });
        }
        self.ring.write(entering.sample);
    }

    /// Starts to read the waiting row, once its time has come.
    #[inline]
    fn begin_reading(&mut self) {
        match &mut self.waiting {
            None => {}
            Some(waiting) if waiting.clocks > 0 => waiting.clocks -= 1,
            Some(waiting) => {
                self.leaving = Some(Reader::start(&waiting.binding, waiting.base, &self.ring, &self.defects));
                self.waiting = None;
            }
        }
    }
}
