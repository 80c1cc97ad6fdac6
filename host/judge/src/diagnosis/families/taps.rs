//! Taps that carry samples other than their own.

use halfrow_model::TAP_NAMES;

use crate::diagnosis::datapath::{DeadTap, Wiring};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;

/// Offsets of the window, dead taps, and a base of the wrong colour.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let offsets = [-1, 1, -2, 2, -3, 3].map(offset);
    let dead = (0..TAP_NAMES.len()).flat_map(|tap| {
        let others = (0..TAP_NAMES.len()).filter(move |&other| other != tap).map(Some);
        std::iter::once(None).chain(others).map(move |reads| dead(DeadTap { tap, reads }))
    });
    offsets.into_iter().chain(dead).chain([other_colour()]).collect()
}

fn offset<'a>(columns: i64) -> Hypothesis<'a> {
    Hypothesis::new(Defect::TapOffset { columns }, move |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        Some(tables.run(&Wiring::default(), |column, _| tables.sample_of(samples, column + columns)).into())
    })
}

fn dead<'a>(dead_tap: DeadTap) -> Hypothesis<'a> {
    let name = |tap: usize| TAP_NAMES.get(tap).copied().unwrap_or_default().to_owned();
    let defect = Defect::TapDead { tap: name(dead_tap.tap), reads: dead_tap.reads.map(name) };
    wired(Wiring { dead_tap: Some(dead_tap), ..Wiring::default() }, defect)
}

fn other_colour<'a>() -> Hypothesis<'a> {
    wired(Wiring { other_colour: true, ..Wiring::default() }, Defect::BaseColourWrong {})
}

/// The defect of a datapath with this wiring.
pub(super) fn wired<'a>(wiring: Wiring, defect: Defect) -> Hypothesis<'a> {
    Hypothesis::new(defect, move |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        Some(tables.run(&wiring, |column, _| tables.sample_of(samples, column)).into())
    })
}
