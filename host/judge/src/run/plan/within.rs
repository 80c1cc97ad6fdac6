//! A run that must keep within a time: what is taken of it is chosen once the board is open and the link is known.

use std::time::Duration;

use super::parts::{Part, Selection};
use super::prices::{Prices, Rates};
use super::{AtSpeed, Plan};
use crate::coverage::{self, Faults, FaultsError};
use crate::result::{CheckName, CoveragePoint, WithinPart, WithinReport};
use crate::run::findings::{During, End};
use crate::run::steps::Run;
use crate::words::hertz;

/// The share of the time that is kept for what has no price: a retry, a slow host.
const KEPT: f64 = 0.05;
/// The same for a link whose speed is only known from a short measurement.
const KEPT_UNSURE: f64 = 0.1;

/// The time that this computer needs in addition while the link's clock goes on, in seconds.
const HOST: f64 = 0.1;

/// A time in which a run cannot do what it is to.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WithinError {
    /// The time to judge within is over before a single row can be judged.
    #[error("{seconds} s is too short for any verdict over this link; give at least {least} s")]
    TooFew {
        /// The time.
        seconds: f64,
        /// The least that would do, rounded up.
        least: f64,
    },
    /// At the pixel clock that the board names, which nothing has checked, the time is over before a row can be judged; over
    /// this link alone it would be enough.
    #[error(
        "{seconds} s is too short at the pixel clock of {} that the board names, but would be enough over this link; \
         look at that clock in a run without a time to judge within, or give at least {least} s", hertz(*clock_hz)
    )]
    TooFewOfClock {
        /// The time.
        seconds: f64,
        /// The least that would do at that clock, rounded up.
        least: f64,
        /// The clock, in hertz.
        clock_hz: u32,
    },
    /// The frames at speed that were asked for do not fit into the time to judge within.
    #[error(
        "the frames at speed that are asked for do not fit into {seconds} s; give at least {least} s, or ask for fewer"
    )]
    AtSpeed {
        /// The time.
        seconds: f64,
        /// The least that would do, rounded up.
        least: f64,
    },
    /// What was measured cannot be read.
    #[error(transparent)]
    Faults(#[from] FaultsError),
}

/// How often at most a link that has lost packets is measured.
const LOOKS: usize = 3;

impl Run<'_> {
    /// Chooses what to take of the plan, for the time `limit` on the run's clock.
    ///
    /// # Errors
    /// [`End`] when the board does not answer, or the time does not suffice.
    pub(in crate::run) fn choose(&mut self, limit: Duration) -> Result<Plan, End> {
        let mut chosen = self.chosen(limit, 0.0)?;
        // A packet that was lost while the link was measured says nothing of the link's speed, nor of the call.
        for _ in 1..LOOKS {
            if chosen.is_err() && self.board.tally().retries > 0 {
                let lost = self.clock().as_secs_f64();
                chosen = self.chosen(limit, lost)?;
            }
        }
        match chosen {
            Ok((selection, report)) => {
                self.findings.within = Some(report);
                Ok(Plan { selection: Some(selection), ..self.plan.clone() })
            }
            Err(error) => Err(self.findings.refuse(error.into())),
        }
    }

    /// What fits into the time `limit` on the run's clock, of which the link has `lost` some seconds, which do not count.
    fn chosen(&mut self, limit: Duration, lost: f64) -> Result<Fitted, End> {
        let rates = Rates::of(self.board).during(CheckName::Link)?;
        let capabilities = self.board.capabilities.clone();
        let prices = Prices::new(self.plan, &capabilities, rates);
        let kept = if self.board.bytes_per_second().is_some() { KEPT } else { KEPT_UNSURE };
        let spent = self.clock().as_secs_f64() - lost;
        let mut time = Time { seconds: limit.as_secs_f64(), spent, kept };
        // By a link's virtual clock choosing takes no time. By a real one it does, and so will choosing again.
        let build = format!("{:08x}", self.board.welcome.build);
        let tried = fitting(&prices, &build, time);
        let took = self.clock().as_secs_f64() - lost - time.spent;
        if took > 0.0 {
            time.spent += 2.0 * took + HOST;
            return Ok(fitting(&prices, &build, time));
        }
        Ok(tried)
    }
}

/// What is taken of a plan, unless too little fits.
type Fitted = Result<(Selection, WithinReport), WithinError>;

/// The time that the run may take.
#[derive(Clone, Copy)]
struct Time {
    /// All of it, in seconds.
    seconds: f64,
    /// What has passed of it, in seconds.
    spent: f64,
    /// The share that is kept as a reserve.
    kept: f64,
}

/// What fits into `time` over a link with these `prices`.
fn fitting(prices: &Prices<'_>, build: &str, time: Time) -> Fitted {
    let faults = Faults::all()?;
    let Time { seconds, spent, kept } = time;
    let left = seconds * (1.0 - kept) - spent;
    let least_for = |selection: &Selection| {
        let least = (spent + prices.seconds(selection)) / (1.0 - kept);
        (prices.seconds(selection) > left).then(|| (least * 1000.0).ceil() / 1000.0)
    };
    let mut from = Selection::least();
    if let Some(least) = least_for(&from) {
        let of_clock = prices.named_clock().filter(|_| prices.at_the_usual_clock(&from) <= left);
        return Err(match of_clock {
            Some(clock_hz) => WithinError::TooFewOfClock { seconds, least, clock_hz },
            None => WithinError::TooFew { seconds, least },
        });
    }
    if matches!(prices.plan.at_speed, AtSpeed::For(_)) && prices.parts().contains(&Part::AtSpeed) {
        from = from.with(Part::AtSpeed, prices.most(Part::AtSpeed));
        if let Some(least) = least_for(&from) {
            return Err(WithinError::AtSpeed { seconds, least });
        }
    }
    let mut choice = coverage::choose(prices, faults, &from, left);
    choice.selection = prices.plan.streamable(&choice.selection);
    let report = report(prices, faults, build, &choice, time);
    Ok((choice.selection, report))
}

fn report(
    prices: &Prices<'_>,
    faults: &Faults,
    build: &str,
    choice: &coverage::Choice,
    Time { seconds, spent, .. }: Time,
) -> WithinReport {
    let plan = prices.plan;
    let part = |part: Part| WithinPart {
        part: plan.name_of(part),
        taken: choice.selection.amount(part).min(prices.most(part)),
        of: prices.most(part),
    };
    let here = faults.scaled(plan.tables.geometry().height());
    let parts: Vec<_> = prices.parts().into_iter().map(part).collect();
    WithinReport {
        seconds,
        expected_seconds: spent + choice.seconds,
        bytes_per_second: Some(prices.rates.bytes_per_second).filter(|rate| rate.is_finite()),
        round_trip: prices.rates.round_trip,
        found: if parts.iter().all(|part| part.taken == part.of) {
            here.found_by_whole()
        } else {
            here.found(&choice.selection)
        },
        parts,
        faults: here.count(),
        measured: faults.are_of(plan, build),
        measured_at: faults.size().into(),
        curve: curve(prices, faults, spent),
    }
}

/// What more and more parts find, and at last a whole run, which also finds faults that no single part is known to find.
fn curve(prices: &Prices<'_>, faults: &Faults, spent: f64) -> Vec<CoveragePoint> {
    let here = faults.scaled(prices.plan.tables.geometry().height());
    let least = Selection::least();
    let whole = prices.parts().into_iter().fold(least, |whole, part| whole.with(part, prices.most(part)));
    let whole = CoveragePoint { seconds: spent + prices.seconds(&whole), found: here.found_by_whole() };
    let steps = coverage::steps(prices, faults, &Selection::least(), f64::INFINITY);
    let points = steps
        .iter()
        .map(|(selection, price)| CoveragePoint { seconds: spent + price, found: here.found(selection) });
    let mut curve: Vec<_> = points.filter(|point| point.seconds < whole.seconds).collect();
    if curve.last().is_none_or(|last| last.found < whole.found) {
        curve.push(whole);
    }
    curve
}
