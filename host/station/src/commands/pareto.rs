//! `halfrow-station pareto`

use clap::Args;
use halfrow::words::{count, plain};

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

fn text(Pareto { products, judged, failed, units, bars }: &Pareto) -> String {
    if *judged == 0 {
        return "no run that matches was judged".to_owned();
    }
    let heading = format!("{failed} of {} failed", count(*judged, "judged run"));
    let products = format!("products: {}", plain(&products.join(", ")));
    if bars.is_empty() {
        return format!("{heading}\n{products}");
    }
    let rows = bars.iter().map(|bar| {
        let name = if bar.name.is_empty() { "no part is suspected" } else { &bar.name };
        vec![name.to_owned(), bar.runs.count.to_string(), bar.runs.text(), bar.units.to_string()]
    });
    format!(
        "{heading}, {} concerned\n{products}\n{}",
        count(*units, "unit"),
        table(&["cause", "runs", "share", "units"], &[1, 3], rows)
    )
}
