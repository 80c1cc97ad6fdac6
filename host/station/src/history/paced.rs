//! What takes long to find is not found anew all the time.

use std::time::{Duration, Instant};

use parking_lot::Mutex;

/// The longest pause.
const LONGEST: Duration = Duration::from_secs(60);

/// What was found last.
#[derive(Debug)]
pub struct Paced<T> {
    rests: u32,
    /// It, and until when it is returned again.
    last: Mutex<Option<(Instant, T)>>,
}

impl<T: Clone> Paced<T> {
    /// Nothing found yet. After each find it pauses `rests` times as long as that took, a minute at most.
    #[must_use]
    pub fn new(rests: u32) -> Self {
        Self { rests, last: Mutex::default() }
    }

    /// What `find` finds, or found last if the pause is not over.
    ///
    /// # Errors
    /// That of `find`.
    pub fn get<E>(&self, find: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        let mut last = self.last.lock();
        let begun = Instant::now();
        if let Some((_, found)) = last.as_ref().filter(|(until, _)| begun < *until) {
            return Ok(found.clone());
        }
        let found = find()?;
        if self.rests > 0 {
            let rest = begun.elapsed().saturating_mul(self.rests).min(LONGEST);
            *last = Some((Instant::now() + rest, found.clone()));
        }
        Ok(found)
    }
}
