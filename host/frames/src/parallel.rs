//! Work that all processors share. If the system grants no more threads, the calling one does it alone: rayon by itself would
//! panic.

use std::error::Error as _;
use std::sync::LazyLock;

use rayon::prelude::*;

/// Whether there are threads to share the work. Starts them if nobody has.
fn is_shared() -> bool {
    static STARTED: LazyLock<bool> = LazyLock::new(|| {
        // An error without a cause means that they are already started.
        rayon::ThreadPoolBuilder::new().build_global().err().is_none_or(|error| error.source().is_none())
    });
    *STARTED
}

/// What `make` returns for each of `items` and its number, in their order.
pub fn map<Item: Sync, Made: Send>(items: &[Item], make: impl Fn(usize, &Item) -> Made + Sync) -> Vec<Made> {
    let make = |(number, item)| make(number, item);
    if is_shared() {
        items.par_iter().enumerate().map(make).collect()
    } else {
        items.iter().enumerate().map(make).collect()
    }
}

/// Does `work` for every number below `count`, with a state that `begin` makes for each thread. The first failure ends the rest.
///
/// # Errors
/// That of the work that failed.
pub fn try_each<State, Failed: Send>(
    count: usize,
    begin: impl Fn() -> State + Sync + Send,
    work: impl Fn(&mut State, usize) -> Result<(), Failed> + Sync + Send,
) -> Result<(), Failed> {
    if is_shared() {
        (0..count).into_par_iter().try_for_each_init(begin, work)
    } else {
        let mut state = begin();
        (0..count).try_for_each(|number| work(&mut state, number))
    }
}

/// Fills `samples` in rows of `width`. `fill` gets the number of the row and its samples.
pub(crate) fn fill_rows(samples: &mut [u16], width: usize, fill: impl Fn(usize, &mut [u16]) + Sync) {
    let fill = |(row, samples): (usize, &mut [u16])| fill(row, samples);
    if is_shared() {
        samples.par_chunks_exact_mut(width).enumerate().for_each(fill);
    } else {
        samples.chunks_exact_mut(width).enumerate().for_each(fill);
    }
}
