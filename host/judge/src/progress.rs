//! Progress of a long run, for whoever watches.

/// Told what a run does.
pub trait Progress: Sync {
    /// A step begins that moves no rows.
    fn step(&self, _what: &str) {}
    /// This many rows will come back in all.
    fn rows_expected(&self, _rows: u64) {}
    /// A frame is being sent.
    fn frame(&self, _name: &str) {}
    /// A row came back.
    fn row(&self) {
        self.rows(1);
    }
    /// As many rows came back, or were computed, at once.
    fn rows(&self, _count: u64) {}
    /// The run is over.
    fn done(&self) {}
}

/// Says nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}
