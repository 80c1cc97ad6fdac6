//! Taps that carry samples other than their own.

use halfrow_model::{Source, TAP_NAMES};

use crate::diagnosis::datapath::{DeadTap, Wiring};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::witnesses::Witnesses;
use crate::result::Defect;

/// Offsets of the window, dead taps, a base of the wrong colour or on the wrong side, and samples of the wrong colour beyond the row's ends.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let offsets = [-1, 1, -2, 2, -3, 3].map(offset);
    let dead = (0..TAP_NAMES.len()).flat_map(|tap| {
        let others = (0..TAP_NAMES.len()).filter(move |&other| other != tap).map(Some);
        std::iter::once(None).chain(others).map(move |reads| dead(DeadTap { tap, reads }))
    });
    offsets.into_iter().chain(dead).chain([other_colour(), base_right(), nearest_edge()]).collect()
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

/// Weights have 14 bits for the distance from the base, in which two columns further right are the same distance.
fn base_right<'a>() -> Hypothesis<'a> {
    Hypothesis::new(Defect::BaseColumnRight {}, |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        let output = |column| {
            let source = tables.source(column);
            let base = if source.base < source.column { source.base + 2 } else { source.base };
            tables.output_of_taps(samples, Source { base, ..source })
        };
        Some((0..samples.len()).map(output).collect::<Vec<_>>().into())
    })
}

fn nearest_edge<'a>() -> Hypothesis<'a> {
    Hypothesis::new(Defect::EdgeColourWrong {}, |witness| {
        let samples = witness.samples();
        let last = samples.len().saturating_sub(1) as i64;
        let nearest = |column: i64, _| samples[column.clamp(0, last) as usize];
        Some(witness.tables().run(&Wiring::default(), nearest).into())
    })
}

/// The defect of a datapath with this wiring.
pub(super) fn wired<'a>(wiring: Wiring, defect: Defect) -> Hypothesis<'a> {
    Hypothesis::new(defect, move |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        Some(tables.run(&wiring, |column, _| tables.sample_of(samples, column)).into())
    })
}
