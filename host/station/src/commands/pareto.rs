//! `halfrow-station pareto`

use clap::Args;
use halfrow::words::count;

use super::Failure;
use super::looking::{Counted, Results, either, table};
use crate::exit::Exit;
use crate::history::pareto::{Of, Pareto, pareto};

/// Count what fails most
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    results: Results,
    /// Count by this
    #[arg(long, value_enum, default_value = "part")]
    by: Of,
    #[command(flatten)]
    counted: Counted,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let pareto = pareto(&arguments.results.snapshot()?, &arguments.counted.wanted()?, arguments.by)?;
    either(&pareto, arguments.json, text)
}

fn text(Pareto { failed, units, bars }: &Pareto) -> String {
    let rows = bars.iter().map(|bar| {
        let name = if bar.name.is_empty() { "no part is suspected" } else { &bar.name };
        vec![name.to_owned(), bar.runs.count.to_string(), bar.runs.text(), bar.units.to_string()]
    });
    format!(
        "{} of {} failed\n{}",
        count(*failed, "run"),
        count(*units, "unit"),
        table(&["cause", "runs", "share", "units"], &[1, 3], rows)
    )
}
