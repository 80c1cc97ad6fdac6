//! The row that the board kept of a frame at the full pixel clock, of which there is no picture.

use maud::{Markup, html};

use crate::compare::{Difference, bits_in};
use crate::result::{Finding, KeptRow, Repetition};
use crate::words::{count, grouped, verb};

/// The section of the row that was kept, if `finding` tells of one.
pub(super) fn section(finding: &Finding) -> Markup {
    match finding {
        Finding::InCorner { found, .. } => section(found),
        Finding::DiffersAtSpeed {
            first,
            repetition: Repetition::Trapped { row, kept: Some(kept), .. },
            ..
        } => of_row(*first, *row, kept),
        _ => Markup::default(),
    }
}

fn of_row(frame: u64, row: usize, kept: &KeptRow) -> Markup {
    let KeptRow { generation, differences, first } = kept;
    html! {
        section {
            h2 { "Row kept at speed" }
            p {
                "Row " (row) " of frame " (grouped(frame)) " at speed, made with the tables of generation " (generation) ": "
                (count(*differences, "sample")) " " (verb(*differences, "differ"))
                @if first.len() < *differences { "; the first " (first.len()) ":" } @else { "." }
            }
            div.scroll tabindex="0" role="region" aria-label="Row kept at speed" { table.frames {
                thead { tr {
                    th.number { "column" } th.number { "expected" } th.number { "found" }
                    th.number { "found − expected" } th { "bits" }
                } }
                tbody { @for it in first { (sample(*it)) } }
            } }
        }
    }
}

fn sample(Difference { column, expected, found, .. }: Difference) -> Markup {
    let bits: Vec<_> = bits_in((expected ^ found).into()).iter().map(u32::to_string).collect();
    html! {
        tr {
            td.number { (column) }
            td.number { (expected) }
            td.number { (found) }
            td.number { (format!("{:+}", i32::from(found) - i32::from(expected))) }
            td { (bits.join(", ")) }
        }
    }
}
