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

/// Frames to be corrected by tables and a kernel, and what the oracle makes of them.
struct Task {
    tables: Arc<TableSet>,
    kernel: Kernel,
    frames: Arc<Vec<Frame>>,
    corrected: Vec<Frame>,
}

impl Task {
    fn of(
        tables: &Arc<TableSet>,
        interpolant: Interpolant,
        frames: &Arc<Vec<Frame>>,
    ) -> Result<Self, Box<dyn Error>> {
        let kernel = Kernel::from(interpolant);
        let corrected =
            frames.iter().map(|frame| correct(tables, &kernel, frame)).collect::<Result<_, _>>()?;
        Ok(Self { tables: Arc::clone(tables), kernel, frames: Arc::clone(frames), corrected })
    }

    /// A benchmark of a wrong result would mean nothing, so it is run once, and its outputs are compared.
    fn check(&self, name: &str, batch: &Batch) -> Result<(), Box<dyn Error>> {
        let equal = batch.outputs.iter().zip(&self.corrected).all(|(found, right)| found == right.samples());
        if equal { Ok(()) } else { Err(format!("{name} differs from the oracle").into()) }
    }
}

/// One frame over and over, which stays in the cache, and a batch of frames that do not.
pub(crate) fn benchmarks() -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let (tables, grid) = (Arc::new(tables(HEIGHT)?), Arc::new(grid(HEIGHT)?));
    let one = Arc::new(vec![frame(HEIGHT, 0)?]);
    let batch = Arc::new(batch()?);
    let [by_rows, by_grid] = [&tables, &grid].map(|by| Task::of(by, Interpolant::Hermite, &batch));
    let (by_rows, by_grid) = (by_rows?, by_grid?);
    let mut benchmarks = vec![copy("memcpy", &one), copy("batch memcpy", &batch)];
    for path in ModelPath::available() {
        for interpolant in [Interpolant::Hermite, Interpolant::Keys] {
            for (tables, what) in [(&tables, ""), (&grid, " grid")] {
                let task = Task::of(tables, interpolant, &one)?;
                benchmarks.push(corrector(format!("{path} {interpolant}{what}"), &task, path, 1)?);
            }
        }
        benchmarks.push(samples(path, &Task::of(&tables, Interpolant::Hermite, &one)?)?);
        benchmarks.push(signer(path, &tables, &Kernel::from(Interpolant::Hermite))?);
        if path != ModelPath::Reference {
            for threads in [1, 2] {
                benchmarks.push(corrector(format!("batch {path} on {threads}"), &by_rows, path, threads)?);
            }
            benchmarks.push(corrector(format!("batch {path} grid"), &by_grid, path, 1)?);
        }
    }
    Ok(benchmarks)
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
fn samples(path: ModelPath, task: &Task) -> Result<Benchmark, Box<dyn Error>> {
    let (mut batch, tables) = (Batch::of(&task.frames), Arc::clone(&task.tables));
    let (name, mut corrector) = (format!("samples {path}"), Corrector::new(path, &task.kernel)?);
    let mut correct_all = move |batch: &mut Batch| {
        for (frame, output) in batch.frames.iter().zip(&mut batch.outputs) {
            let samples = black_box(frame.samples());
            assert!(black_box(corrector.correct_samples(&tables, samples, black_box(output))).is_ok());
        }
    };
    correct_all(&mut batch);
    task.check(&name, &batch)?;
    Ok(Benchmark { name, run: Box::new(move || correct_all(&mut batch)) })
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

/// Shares the frames equally among so many threads; the calling thread is one of them.
fn corrector(
    name: String,
    task: &Task,
    path: ModelPath,
    threads: usize,
) -> Result<Benchmark, Box<dyn Error>> {
    let (mut batch, tables) = (Batch::of(&task.frames), Arc::clone(&task.tables));
    let share = batch.frames.len().div_ceil(threads);
    let correctors = (0..threads).map(|_| Corrector::new(path, &task.kernel));
    let mut correctors = correctors.collect::<Result<Vec<_>, _>>()?;
    let mut correct_all = move |batch: &mut Batch| {
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
    correct_all(&mut batch);
    task.check(&name, &batch)?;
    Ok(Benchmark { name, run: Box::new(move || correct_all(&mut batch)) })
}

fn correct_share(share: (&mut Corrector, &[Frame], &mut [Vec<u16>]), tables: &TableSet) {
    let (corrector, frames, outputs) = share;
    for (frame, output) in frames.iter().zip(outputs) {
        assert!(black_box(corrector.correct_into(tables, black_box(frame), black_box(output))).is_ok());
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
