//! Taps that carry other samples than their own.

use crate::diagnosis::datapath::{DeadTap, Wiring};
use crate::diagnosis::hypothesis::{Cause, Hypothesis};
use crate::diagnosis::witnesses::Witnesses;

/// The taps in their order.
const TAPS: [&str; 7] = ["G0", "R1", "G2", "R3", "G4", "R5", "G6"];

/// Offsets of the window, dead taps, and a base of the wrong colour.
pub(super) fn propose<'a>(_: &Witnesses<'a>) -> Vec<Hypothesis<'a>> {
    let offsets = [-1, 1, -2, 2, -3, 3].map(offset);
    let dead = (0..TAPS.len()).flat_map(|tap| {
        let others = (0..TAPS.len()).filter(move |&other| other != tap).map(Some);
        std::iter::once(None).chain(others).map(move |reads| dead(DeadTap { tap, reads }))
    });
    offsets.into_iter().chain(dead).chain([other_colour()]).collect()
}

fn offset<'a>(columns: i64) -> Hypothesis<'a> {
    let side = if columns < 0 { "left" } else { "right" };
    let distance = match columns.abs() {
        1 => "one column".to_owned(),
        more => format!("{more} columns"),
    };
    let cause = Cause {
        part: "tap offset",
        place: format!("the window's read address, {distance} to the {side}"),
        defect: "every tap taken from there".to_owned(),
        next_step: "Check the offset between the source column and the line memory's read address."
            .to_owned(),
    };
    Hypothesis::new(cause, move |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        Some(tables.run(&Wiring::default(), |column, _| tables.sample_of(samples, column + columns)).into())
    })
}

fn dead<'a>(dead_tap: DeadTap) -> Hypothesis<'a> {
    let name = |tap: usize| TAPS.get(tap).copied().unwrap_or_default();
    let tap = name(dead_tap.tap);
    let reads =
        dead_tap.reads.map_or_else(|| "stuck at 0".to_owned(), |other| format!("reading {}", name(other)));
    let cause = Cause {
        part: "dead tap",
        place: format!("tap {tap}, {reads}"),
        defect: "this tap alone".to_owned(),
        next_step: format!("Check the window's register of tap {tap}, and its way to the multipliers."),
    };
    wired(Wiring { dead_tap: Some(dead_tap), ..Wiring::default() }, cause)
}

fn other_colour<'a>() -> Hypothesis<'a> {
    let cause = Cause {
        part: "colour",
        place: "the base column's colour".to_owned(),
        defect: "taking samples of the row's other colour".to_owned(),
        next_step: "Check the parity that chooses between the base columns n and n - 1.".to_owned(),
    };
    wired(Wiring { other_colour: true, ..Wiring::default() }, cause)
}

/// The defect of a datapath that is wired like this.
pub(super) fn wired<'a>(wiring: Wiring, cause: Cause) -> Hypothesis<'a> {
    Hypothesis::new(cause, move |witness| {
        let (tables, samples) = (witness.tables(), witness.samples());
        Some(tables.run(&wiring, |column, _| tables.sample_of(samples, column)).into())
    })
}
