//! Judges a board that has one fault in its Verilog by verify's own plan, and prints what found it. `scripts/hardware coverage`
//! builds the boards and collects what this prints; fpga/checks/README.md says what results.

mod judged;

use std::path::Path;

use anyhow::{Result, bail};
use halfrow::Plan;
use halfrow::model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use halfrow::run::Vary;
use halfrow_sim::FaultyBoard;

use judged::judge;

const USAGE: &str = "halfrow-coverage LIBRARY WIDTH HEIGHT RADIUS FAULT";

// A tool of the project's own scripts, which read what it prints.
#[allow(clippy::print_stdout)]
#[expect(clippy::disallowed_macros, reason = "a wrong call of it is those scripts' mistake, and has no code")]
fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [library, width, height, radius, fault] = &words[..] else { bail!("usage: {USAGE}") };
    let plan = plan(width.parse()?, height.parse()?, radius.parse()?)?;
    let mut board = loaded(Path::new(library))?;
    println!("{}", serde_json::to_string(&judge(&plan, &mut board, fault.parse()?)?)?);
    Ok(())
}

/// The board in this library.
#[allow(unsafe_code)]
fn loaded(library: &Path) -> Result<FaultyBoard> {
    // SAFETY: only `scripts/hardware coverage` calls this program, with a library that it has built; and this is called once.
    Ok(unsafe { FaultyBoard::load(library) }?)
}

/// The plan of `halfrow verify --width W --height H --radius R`.
fn plan(width: usize, height: usize, radius: f64) -> Result<Plan> {
    let lens = Equidistant::from_radius(radius)?;
    let tables = TableSet::from_lens(Geometry::centred(width, height, BitDepth::Twelve)?, &lens, None)?;
    let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
    Ok(plan.varying(Vary { centre: true, depth: true }))
}
