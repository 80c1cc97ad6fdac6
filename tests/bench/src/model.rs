//! The model's paths beside a copy of the frame.

use std::error::Error;
use std::hint::black_box;
use std::num::NonZero;
use std::rc::Rc;

use halfrow_model::{Corrector, Frame, Interpolant, Kernel, ModelPath, TableSet, correct};

use crate::Benchmark;
use crate::scene::{frame, tables};

/// Rows of a whole frame.
const HEIGHT: usize = 1080;

/// Frames that take turns where a batch is timed: with their outputs twice what a cache of 64 MiB holds.
const BATCH: usize = 16;

/// Rows of a frame whose instructions are counted.
const COUNTED: usize = 32;

/// Frames that one benchmark works on, and where their outputs go.
struct Batch {
    frames: Rc<Vec<Frame>>,
    outputs: Vec<Vec<u16>>,
}

impl Batch {
    fn of(frames: &Rc<Vec<Frame>>) -> Self {
        let outputs = frames.iter().map(|frame| vec![0; frame.samples().len()]).collect();
        Self { frames: Rc::clone(frames), outputs }
    }

    fn each(&mut self, mut work: impl FnMut(&Frame, &mut [u16])) {
        for (frame, output) in self.frames.iter().zip(&mut self.outputs) {
            work(black_box(frame), black_box(output));
        }
    }
}

/// One frame again and again, as it stays in the cache, and a batch whose frames do not.
pub(crate) fn benchmarks() -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let tables = Rc::new(tables(HEIGHT)?);
    let one = Rc::new(vec![frame(HEIGHT, 0)?]);
    let batch = (0..BATCH).map(|index| frame(HEIGHT, index as u32)).collect::<Result<Vec<_>, _>>()?;
    let batch = Rc::new(batch);
    let mut benchmarks = vec![copy("memcpy", &one), copy("batch memcpy", &batch)];
    for path in ModelPath::available() {
        for interpolant in [Interpolant::Hermite, Interpolant::Keys] {
            let kernel = Kernel::from(interpolant);
            check(&tables, &kernel, &one[0], path)?;
            let name = format!("{path} {interpolant}");
            benchmarks.push(corrector(name, &one, &tables, Corrector::new(path, &kernel)?, 1));
        }
        let kernel = Kernel::from(Interpolant::Hermite);
        for threads in [1, 2] {
            let name = format!("batch {path} on {threads}");
            benchmarks.push(corrector(name, &batch, &tables, Corrector::new(path, &kernel)?, threads));
        }
    }
    Ok(benchmarks)
}

/// A benchmark of a wrong result would mean nothing.
fn check(tables: &TableSet, kernel: &Kernel, frame: &Frame, path: ModelPath) -> Result<(), Box<dyn Error>> {
    let equal = Corrector::new(path, kernel)?.correct(tables, frame)? == correct(tables, kernel, frame)?;
    if equal { Ok(()) } else { Err(format!("the path {path} differs from the oracle").into()) }
}

fn copy(name: &str, frames: &Rc<Vec<Frame>>) -> Benchmark {
    let mut batch = Batch::of(frames);
    let run = move || batch.each(|frame, output| output.copy_from_slice(frame.samples()));
    Benchmark { name: name.to_owned(), run: Box::new(run) }
}

fn corrector(
    name: String,
    frames: &Rc<Vec<Frame>>,
    tables: &Rc<TableSet>,
    mut corrector: Corrector,
    threads: usize,
) -> Benchmark {
    let (mut batch, tables) = (Batch::of(frames), Rc::clone(tables));
    let threads = NonZero::new(threads).unwrap_or(NonZero::<usize>::MIN);
    let run = move || {
        batch.each(|frame, output| {
            // The frames are of the tables' size and depth, which `check` has seen.
            let _ = black_box(corrector.correct_into(&tables, frame, threads, output));
        });
    };
    Benchmark { name, run: Box::new(run) }
}

/// Corrects `COUNTED` rows `frames` times.
pub(crate) fn count(path: ModelPath, interpolant: Interpolant, frames: usize) -> Result<(), Box<dyn Error>> {
    let (tables, frame) = (tables(COUNTED)?, frame(COUNTED, 0)?);
    let mut corrector = Corrector::new(path, &Kernel::from(interpolant))?;
    let mut output = vec![0; frame.samples().len()];
    for _ in 0..frames {
        corrector.correct_into(&tables, black_box(&frame), NonZero::<usize>::MIN, black_box(&mut output))?;
    }
    Ok(())
}
