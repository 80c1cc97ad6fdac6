//! Work shared out among all processors, or among more workers than that.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::JoinHandle;

/// Waits for a thread that worked alongside a test, if there is one, when the test needs it no more. Returns what came of it;
/// nothing if there is none.
///
/// # Panics
/// When the thread panicked, which a test that passes would not show; not while the test itself panics.
pub(crate) fn end_beside<T>(worker: Option<JoinHandle<T>>) -> Option<T> {
    match worker?.join() {
        Ok(result) => Some(result),
        Err(panic) if !std::thread::panicking() => resume_unwind(panic),
        Err(_) => None,
    }
}

/// The result of `work` for every item, in the order of the items.
///
/// # Panics
/// When `work` panics.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    map_by(std::thread::available_parallelism().map_or(1, usize::from), items, work)
}

/// Like [`map`], by `workers` threads, for work that mostly waits.
///
/// # Panics
/// When `work` panics.
pub fn map_by<T: Sync, R: Send>(workers: usize, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let share = || {
        let mine = std::iter::from_fn(|| {
            let index = next.fetch_add(1, Ordering::Relaxed);
            items.get(index).map(|item| (index, work(item)))
        });
        mine.collect::<Vec<_>>()
    };
    let mut results = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(share)).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect::<Vec<_>>()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}
