//! What share of faults runs of 1920 x 1080 find in how many seconds, on three links. The parts are chosen by every second
//! measured fault, and checked on the others. Each run is made on the mock, whose clock says how long it took.
//!
//! `cargo run --release --example coverage_curve -- pace=real` makes the runs in real time.

use std::error::Error;
use std::time::{Duration, Instant};

use halfrow::coverage::{Faults, Which, choose};
use halfrow::model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use halfrow::progress::Silent;
use halfrow::run::{Build, Prices, Rates, RunOptions, Selection, Vary, usual_capabilities};
use halfrow::{Plan, link, verify};

/// UARTs of 3 and 12 Mbaud and a FIFO, in bytes a second.
const LINKS: [(&str, f64); 3] = [("3 Mbaud", 300_000.0), ("12 Mbaud", 1_200_000.0), ("FIFO", 5_000_000.0)];
const ROUND_TRIP: f64 = 0.001;
/// The share of its time that a run keeps as a reserve.
const KEPT: f64 = 0.05;

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn Error>> {
    let pace = std::env::args().nth(1).unwrap_or_else(|| "pace=virtual".to_owned());
    let lens = Equidistant::default();
    let tables = TableSet::from_lens(Geometry::centred(1920, 1080, BitDepth::Twelve)?, &lens, None)?;
    let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
    let plan = plan.varying(Vary { centre: true, depth: true });
    let [chosen_by, checked_on] = [Faults::measured(Which::Even)?, Faults::measured(Which::Odd)?];
    let share = |faults: &Faults, selection: &Selection| {
        let found = faults.scaled(1080).found(selection);
        100.0 * found as f64 / faults.count() as f64
    };
    println!("{} faults chosen by, {} checked on", chosen_by.count(), checked_on.count());
    let capabilities = usual_capabilities(&plan, halfrow::board::BoardNature::Mock);
    let whole = Selection::all(plan.parts(&Build::of(&capabilities)));
    println!("whole run: {:.1} % and {:.1} %", share(&chosen_by, &whole), share(&checked_on, &whole));
    for (name, bytes_per_second) in LINKS {
        let prices = Prices::new(&plan, &capabilities, Rates { bytes_per_second, round_trip: ROUND_TRIP });
        for seconds in [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0] {
            let left = seconds * (1.0 - KEPT) - prices.opening();
            let choice = choose(&prices, &chosen_by, &Selection::least(), left);
            let target = format!("mock,speed={bytes_per_second},delay={},{pace}", ROUND_TRIP / 2.0);
            let run = Plan { selection: Some(choice.selection.clone()), ..plan.clone() };
            let begun = Instant::now();
            let judged = verify(&run, link::open(&target.parse()?)?, &RunOptions::default(), &Silent)?;
            let (taken, wall) = (judged.report.link.seconds, begun.elapsed());
            let (own, other) = (share(&chosen_by, &choice.selection), share(&checked_on, &choice.selection));
            println!(
                "{name:<9} {seconds:>5} s: {own:5.1} % {other:5.1} %, took {taken:6.2} s, {:6.2} s here, {}",
                wall.max(Duration::ZERO).as_secs_f64(),
                judged.report.verdict(),
            );
        }
    }
    Ok(())
}
