//! The pipeline between the ring's read and the output.

/// A sample that leaves the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaving {
    /// The corrected sample.
    pub sample: u16,
    /// Its column, from 0.
    pub column: u16,
}

/// Samples on their way out. The line moves on every pixel clock, whether or not a sample entered it.
#[derive(Debug)]
pub(crate) struct DelayLine {
    stages: Vec<Option<Leaving>>,
    oldest: usize,
}

impl DelayLine {
    /// An empty line of `clocks` pixel clocks, at least one.
    pub(crate) fn new(clocks: usize) -> Self {
        Self { stages: vec![None; clocks], oldest: 0 }
    }

    /// One pixel clock: what entered the line `clocks` ago leaves it.
    #[inline]
    pub(crate) fn step(&mut self, made: Option<Leaving>) -> Option<Leaving> {
        let leaving = std::mem::replace(&mut self.stages[self.oldest], made);
        self.oldest += 1;
        if self.oldest == self.stages.len() {
            self.oldest = 0;
        }
        leaving
    }
}
