//! How far something long has come.

/// How far it has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is counted, in words that follow a number, such as "runs read".
    pub what: &'static str,
    /// How many are done.
    pub done: usize,
    /// How many there are, where that is known.
    pub of: Option<usize>,
}

/// Who is told how far something has come, from time to time.
pub type Told<'a> = &'a mut dyn FnMut(Progress);
