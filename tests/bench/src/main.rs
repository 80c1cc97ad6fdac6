//! Runs benchmarks on request, so that `scripts/bench` can let those of several programs take turns.
//!
//! Without arguments it prints the names of its benchmarks, one a line, and an empty line. Then, for every line `TIMES NAME` that
//! it reads, it runs that benchmark that many times and prints the nanoseconds that all of it took.
//! `halfrow-bench PATH KERNEL [grid] FRAMES` corrects some rows FRAMES times by one path of the model, by one factor a row or by
//! a grid, and ends: `scripts/instructions` counts the instructions of that.

mod chain;
mod mock;
mod model;
mod scene;

use std::error::Error;
use std::io::{BufRead, Write};
use std::time::Instant;

/// Something that is run many times.
struct Benchmark {
    name: String,
    run: Box<dyn FnMut()>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [] => serve(
            [model::benchmarks()?, chain::benchmarks()?, mock::benchmarks()?].into_iter().flatten().collect(),
        ),
        [path, kernel, frames] => model::count(path.parse()?, kernel.parse()?, false, frames.parse()?),
        [path, kernel, grid, frames] if grid == "grid" => {
            model::count(path.parse()?, kernel.parse()?, true, frames.parse()?)
        }
        _ => Err("usage: halfrow-bench, or halfrow-bench PATH KERNEL [grid] FRAMES".into()),
    }
}

#[allow(clippy::disallowed_methods)]
fn serve(mut benchmarks: Vec<Benchmark>) -> Result<(), Box<dyn Error>> {
    let mut output = std::io::stdout().lock();
    for benchmark in &benchmarks {
        writeln!(output, "{}", benchmark.name)?;
    }
    writeln!(output)?;
    output.flush()?;
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let (times, name) = line.split_once(' ').ok_or("a line is TIMES NAME")?;
        let times: u32 = times.parse()?;
        let benchmark = benchmarks.iter_mut().find(|benchmark| benchmark.name == name);
        let benchmark = benchmark.ok_or_else(|| format!("there is no benchmark {name}"))?;
        let started = Instant::now();
        for _ in 0..times {
            (benchmark.run)();
        }
        writeln!(output, "{}", started.elapsed().as_nanos())?;
        output.flush()?;
    }
    Ok(())
}
