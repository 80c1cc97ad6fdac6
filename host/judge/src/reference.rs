//! The reference model in this process: the same path for all frames, verified by the golden values.

use std::sync::{Mutex, OnceLock, PoisonError};

use halfrow_model::{CorrectError, Corrector, Frame, Kernel, ModelPath, TableSet, UnavailablePath};

static CHOSEN: OnceLock<ModelPath> = OnceLock::new();

/// Makes the process use `path`, unless it uses one already; with none, the fastest path of this processor.
///
/// # Errors
/// [`UnavailablePath`] when this processor does not support it.
pub fn choose(path: Option<ModelPath>) -> Result<ModelPath, UnavailablePath> {
    match path {
        Some(path) if !path.is_available() => Err(UnavailablePath(path)),
        path => Ok(*CHOSEN.get_or_init(|| path.unwrap_or_else(ModelPath::best))),
    }
}

/// The path that the process uses: the chosen one, or else the fastest of this processor.
#[must_use]
pub fn path() -> ModelPath {
    *CHOSEN.get_or_init(ModelPath::best)
}

/// How many kernels' correctors are kept: those of a run's own tables and of its decoys, and as many for a second run at the same
/// time.
const KEPT: usize = 4;

/// The correctors used last, the newest first. For plain Rust, preparing a kernel takes as long as correcting three quarters of a
/// million samples, and a run corrects many small frames.
static MADE: Mutex<Vec<(Kernel, Corrector)>> = Mutex::new(Vec::new());

/// A corrector for `kernel`, by the process's path.
#[must_use]
pub fn corrector(kernel: &Kernel) -> Corrector {
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    match made.iter().position(|(of, _)| of == kernel) {
        Some(place) => made[..=place].rotate_right(1),
        None => {
            let corrector = Corrector::new(path(), kernel).unwrap_or_else(|_| Corrector::oracle(kernel));
            made.insert(0, (kernel.clone(), corrector));
            made.truncate(KEPT);
        }
    }
    made[0].1.clone()
}

/// The corrected frame: what a board must return.
///
/// # Errors
/// [`CorrectError`] when the frame has another size or depth than the tables are for.
pub fn correct(tables: &TableSet, kernel: &Kernel, frame: &Frame) -> Result<Frame, CorrectError> {
    corrector(kernel).correct(tables, frame)
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Geometry, Interpolant, RowFactor};

    use super::*;

    #[test]
    fn each_kernel_is_corrected_by_its_own_corrector_however_many_there_are() {
        let geometry = Geometry::new(64, 1, BitDepth::Twelve, 63).unwrap();
        let row_factor = RowFactor::new(14_648_488).unwrap();
        let row: Vec<u16> = (0..64).map(|column| column * 1021 % 4096).collect();
        let corrected = |mut corrector: Corrector| {
            let mut output = vec![0; 64];
            corrector.correct_row(&geometry, row_factor, &row, &mut output);
            output
        };
        // More than are kept, so that some are dropped and made again.
        let kernels: Vec<_> = (0..KEPT as i16 + 2)
            .map(|change| {
                let mut nodes = Kernel::from(Interpolant::Hermite).nodes().to_vec();
                nodes.iter_mut().for_each(|node| node[1] += 16 * change);
                Kernel::from_nodes(nodes).unwrap()
            })
            .collect();
        for kernel in kernels.iter().chain(&kernels[..2]).chain(&kernels) {
            assert_eq!(corrected(corrector(kernel)), corrected(Corrector::oracle(kernel)));
        }
        assert_ne!(corrected(corrector(&kernels[0])), corrected(corrector(&kernels[1])));
    }
}
