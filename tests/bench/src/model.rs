//! The model's paths, compared with a copy of the frame.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use halfrow_model::{
    Content, Corrector, Frame, Interpolant, Kernel, ModelPath, Phase, Signer, TableSet, correct,
    frame_signature, row_signature,
};

use crate::Benchmark;
use crate::scene::{HEIGHT, batch, frame, grid, tables};

/// Rows of a frame whose instructions are counted.
const COUNTED: usize = 32;

/// The frames of one benchmark, and room for their outputs.
struct Batch {
    frames: Arc<Vec<Frame>>,
    outputs: Vec<Vec<u16>>,
}

impl Batch {
    fn of(frames: &Arc<Vec<Frame>>) -> Self {
        let outputs = frames.iter().map(|frame| vec![0; frame.samples().len()]).collect();
        Self { frames: Arc::clone(frames), outputs }
    }
}

/// One frame over and over, which stays in the cache, and a batch of frames that do not.
pub(crate) fn benchmarks() -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let (tables, grid) = (Arc::new(tables(HEIGHT)?), Arc::new(grid(HEIGHT)?));
    let one = Arc::new(vec![frame(HEIGHT, 0)?]);
    let batch = Arc::new(batch()?);
    let mut benchmarks = vec![copy("memcpy", &one), copy("batch memcpy", &batch)];
    for path in ModelPath::available() {
        for interpolant in [Interpolant::Hermite, Interpolant::Keys] {
            let kernel = Kernel::from(interpolant);
            for (tables, what) in [(&tables, ""), (&grid, " grid")] {
                check(tables, &kernel, &one[0], path)?;
                let name = format!("{path} {interpolant}{what}");
                benchmarks.push(corrector(name, &one, tables, vec![Corrector::new(path, &kernel)?]));
            }
        }
        let kernel = Kernel::from(Interpolant::Hermite);
        benchmarks.push(samples(path, &one, &tables, &kernel)?);
        benchmarks.push(signer(path, &tables, &kernel)?);
        let threads = if path == ModelPath::Reference { &[][..] } else { &[1, 2] };
        for &threads in threads {
            let name = format!("batch {path} on {threads}");
            let correctors = (0..threads).map(|_| Corrector::new(path, &kernel)).collect::<Result<_, _>>()?;
            benchmarks.push(corrector(name, &batch, &tables, correctors));
        }
        if path != ModelPath::Reference {
            let name = format!("batch {path} grid");
            benchmarks.push(corrector(name, &batch, &grid, vec![Corrector::new(path, &kernel)?]));
        }
    }
    Ok(benchmarks)
}

/// A benchmark of a wrong result would mean nothing, so the result is compared first.
fn check(tables: &TableSet, kernel: &Kernel, frame: &Frame, path: ModelPath) -> Result<(), Box<dyn Error>> {
    let equal = Corrector::new(path, kernel)?.correct(tables, frame)? == correct(tables, kernel, frame)?;
    if equal { Ok(()) } else { Err(format!("the path {path} differs from the oracle").into()) }
}

fn copy(name: &str, frames: &Arc<Vec<Frame>>) -> Benchmark {
    let mut batch = Batch::of(frames);
    let run = move || {
        for (frame, output) in batch.frames.iter().zip(&mut batch.outputs) {
            black_box(output).copy_from_slice(black_box(frame.samples()));
        }
    };
    Benchmark { name: name.to_owned(), run: Box::new(run) }
}

/// Raw samples, which no [`Frame`] has checked.
fn samples(
    path: ModelPath,
    frames: &Arc<Vec<Frame>>,
    tables: &Arc<TableSet>,
    kernel: &Kernel,
) -> Result<Benchmark, Box<dyn Error>> {
    let (mut batch, tables) = (Batch::of(frames), Arc::clone(tables));
    let mut corrector = Corrector::new(path, kernel)?;
    let run = move || {
        for (frame, output) in batch.frames.iter().zip(&mut batch.outputs) {
            let _ =
                black_box(corrector.correct_samples(&tables, black_box(frame.samples()), black_box(output)));
        }
    };
    Ok(Benchmark { name: format!("samples {path}"), run: Box::new(run) })
}

/// A frame of a burst made, corrected and signed.
fn signer(path: ModelPath, tables: &Arc<TableSet>, kernel: &Kernel) -> Result<Benchmark, Box<dyn Error>> {
    let (tables, content) = (Arc::clone(tables), Content { seed: 1, frame: 0 });
    let mut signer = Signer::new(Corrector::new(path, kernel)?);
    let made = content.frame(tables.geometry(), Phase::Grbg);
    let rows: Vec<_> = correct(&tables, kernel, &made)?.rows().map(row_signature).collect();
    let mut signed = Vec::new();
    if signer.sign(&tables, content, &mut signed) != frame_signature(&rows) {
        return Err(format!("the path {path} signs otherwise than the oracle").into());
    }
    let run = move || {
        black_box(signer.sign(&tables, black_box(content), &mut signed));
    };
    Ok(Benchmark { name: format!("signed {path}"), run: Box::new(run) })
}

/// Shares the frames equally among as many threads as there are correctors; the calling thread is one of them.
fn corrector(
    name: String,
    frames: &Arc<Vec<Frame>>,
    tables: &Arc<TableSet>,
    mut correctors: Vec<Corrector>,
) -> Benchmark {
    let (mut batch, tables) = (Batch::of(frames), Arc::clone(tables));
    let share = batch.frames.len().div_ceil(correctors.len());
    let run = move || {
        let shares = batch.frames.chunks(share).zip(batch.outputs.chunks_mut(share));
        std::thread::scope(|scope| {
            let mut own = None;
            for (corrector, (frames, outputs)) in correctors.iter_mut().zip(shares) {
                let tables = &tables;
                if let Some(share) = own.replace((corrector, frames, outputs)) {
                    scope.spawn(move || correct_share(share, tables));
                }
            }
            if let Some(share) = own {
                correct_share(share, &tables);
            }
        });
    };
    Benchmark { name, run: Box::new(run) }
}

fn correct_share(share: (&mut Corrector, &[Frame], &mut [Vec<u16>]), tables: &TableSet) {
    let (corrector, frames, outputs) = share;
    for (frame, output) in frames.iter().zip(outputs) {
        // The frames have the tables' size and depth: `check` has seen to it.
        let _ = black_box(corrector.correct_into(tables, black_box(frame), black_box(output)));
    }
}

/// Corrects `COUNTED` rows `frames` times, by one factor a row or by a grid.
pub(crate) fn count(
    path: ModelPath,
    interpolant: Interpolant,
    behind_grid: bool,
    frames: usize,
) -> Result<(), Box<dyn Error>> {
    let tables = if behind_grid { grid(COUNTED)? } else { tables(COUNTED)? };
    let frame = frame(COUNTED, 0)?;
    let mut corrector = Corrector::new(path, &Kernel::from(interpolant))?;
    let mut output = vec![0; frame.samples().len()];
    for _ in 0..frames {
        corrector.correct_into(&tables, black_box(&frame), black_box(&mut output))?;
    }
    Ok(())
}
