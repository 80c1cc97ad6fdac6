//! Which parts of a run to take for a given time.

use std::collections::BTreeMap;

use super::Faults;
use super::faults::FRAMES;
use crate::frames::Builtin;
use crate::run::{FrameSource, Part, Plan, Prices, Selection};

/// What is taken of a run.
#[derive(Clone, Debug)]
pub struct Choice {
    /// What is taken.
    pub selection: Selection,
    /// Its price in seconds, from the link test on.
    pub seconds: f64,
}

/// Starts at `from` and adds what finds most of `faults` a second, out of the run that `prices` describe, until `seconds` are
/// spent. When nothing finds any more faults, adds the rest of the run in its order.
#[must_use]
pub fn choose(prices: &Prices<'_>, faults: &Faults, from: &Selection, seconds: f64) -> Choice {
    let steps = steps(prices, faults, from, seconds);
    let selection = steps.last().map_or(from, |(selection, _)| selection);
    let selection = fill(prices, selection.clone(), seconds);
    Choice { seconds: prices.seconds(&selection), selection }
}

/// The steps of such a choice, each with its price. The first is `from`.
#[must_use]
pub fn steps(prices: &Prices<'_>, faults: &Faults, from: &Selection, seconds: f64) -> Vec<(Selection, f64)> {
    let faults = faults.scaled(prices.most(Part::Judged(0)));
    let mut steps = vec![(from.clone(), prices.seconds(from))];
    while let Some((selection, spent)) = steps.last() {
        match step(prices, &faults, selection, *spent, seconds) {
            Some(next) => steps.push(next),
            None => break,
        }
    }
    steps
}

/// The selection with the part added that finds most faults a second beyond those that `selection` finds.
fn step(
    prices: &Prices<'_>,
    faults: &Faults,
    selection: &Selection,
    spent: f64,
    seconds: f64,
) -> Option<(Selection, f64)> {
    let worth = gains(prices, faults, selection).into_iter().filter_map(|((part, amount), gain)| {
        let more = selection.with(part, amount);
        let price = prices.seconds(&more);
        (price <= seconds).then(|| (gain as f64 / (price - spent).max(f64::MIN_POSITIVE), more, price))
    });
    let best = worth.max_by(|(one, ..), (other, ..)| one.total_cmp(other));
    best.map(|(_, more, price)| (more, price))
}

/// How many more faults each amount of a part finds, taken by itself.
fn gains(prices: &Prices<'_>, faults: &Faults, selection: &Selection) -> BTreeMap<(Part, usize), usize> {
    let parts: Vec<_> =
        prices.parts().into_iter().filter(|&part| is_as_measured(prices.plan, part)).collect();
    let mut gains = BTreeMap::new();
    for (fault, count) in faults.groups.iter().filter(|(fault, _)| !fault.is_found(selection)) {
        let at_speed = fault.at_speed.then_some((Part::AtSpeed, FRAMES));
        let corners = fault.corners.then_some((Part::Corners, 1));
        let rules = fault.rules.then_some((Part::Rules, 1));
        let finding = fault.rows.iter().copied().chain(at_speed).chain(corners).chain(rules);
        for place in finding.filter(|(part, _)| parts.contains(part)) {
            *gains.entry(place).or_default() += count;
        }
    }
    // More rows also find what fewer rows find.
    let (mut last, mut sum) = (None, 0);
    for (&(part, _), gain) in &mut gains {
        sum = if last == Some(part) { sum + *gain } else { *gain };
        last = Some(part);
        *gain = sum;
    }
    gains
}

/// Whether `part` of `plan` is the one that faults were measured with.
fn is_as_measured(plan: &Plan, part: Part) -> bool {
    let Part::Judged(place) = part else { return true };
    let usual = Builtin::ALL.get(place);
    matches!((plan.frames.get(place), usual), (Some(FrameSource::Builtin(own)), Some(usual)) if own == usual)
}

/// The selection with everything added that there is time for, in the order of the run.
fn fill(prices: &Prices<'_>, selection: Selection, seconds: f64) -> Selection {
    prices.parts().into_iter().fold(selection, |selection, part| {
        let fits = |amount: usize| {
            let more = selection.with(part, amount);
            (prices.seconds(&more) <= seconds).then_some(more)
        };
        let (mut had, mut too_much) = (selection.amount(part), prices.most(part) + 1);
        let mut filled = None;
        // A price never falls as the amount rises.
        while had + 1 < too_much {
            let amount = usize::midpoint(had, too_much).max(had + 1);
            match fits(amount) {
                Some(more) => (had, filled) = (amount, Some(more)),
                None => too_much = amount,
            }
        }
        filled.unwrap_or(selection)
    })
}
