//! The tables and lists of the page.

use maud::{Markup, html};

use crate::report::shell_word;
use crate::report::wording;
use crate::result::{FrameReport, LinkReport, Outcome, Report, TablesReport};
use crate::words::{count, grouped, plain};

/// The most rows of the table of frames.
const MOST_FRAMES: usize = 400;

/// The word of an outcome, in its colour.
pub(super) fn mark(outcome: Outcome) -> Markup {
    let word = wording::mark(outcome);
    html! { span.mark.(word.to_lowercase()) { (word) } }
}

/// The table of frames.
pub(super) fn frames(report: &Report) -> Markup {
    if report.frames.is_empty() {
        return Markup::default();
    }
    let (listed, left_out) = wording::worth_listing(report, MOST_FRAMES);
    let any_differs = report.frames.iter().any(|frame| frame.comparison.first.is_some());
    html! {
        section {
            h2 { "Frames" }
            div.scroll tabindex="0" role="region" aria-label="Frames" { table.frames {
                thead { tr {
                    th { "result" } th.number { "frame" } th { "name" } th { "timing" } th.number { "rows" }
                    th.number { "differences" }
                    @if any_differs {
                        th.number { "first at" } th.number { "expected" } th.number { "found" } th.number { "largest" }
                    }
                } }
                tbody { @for frame in listed { (frame_row(report, frame, any_differs)) } }
            } }
            @if left_out > 0 { p { "And " (count(left_out, "more frame")) "." } }
        }
    }
}

fn frame_row(report: &Report, frame: &FrameReport, any_differs: bool) -> Markup {
    let comparison = &frame.comparison;
    html! {
        tr {
            td { (mark(wording::frame_outcome(report, frame))) }
            td.number { (frame.number) }
            td.name { (wording::frame_name(frame)) }
            td { (frame.timing) }
            td.number { (grouped(frame.rows)) }
            td.number { (wording::differences(report, frame)) }
            @if let Some(first) = comparison.first {
                td.number { (first.row) ", " (first.column) }
                td.number { (first.expected) }
                td.number { (first.found) }
                td.number { (comparison.largest) }
            } @else if any_differs { td {} td {} td {} td {} }
        }
    }
}

/// What a run measured, and its coverage.
pub(super) fn figures(report: &Report) -> Markup {
    let figures = [
        ("Latency", report.latency.as_ref().map(wording::latency)),
        ("Street", wording::street(report)),
        ("Coverage", wording::coverage(report)),
    ];
    let pairs: Vec<_> = figures.into_iter().filter_map(|(name, figure)| Some(pair(name, figure?))).collect();
    if pairs.is_empty() {
        return Markup::default();
    }
    html! { section { h2 { "Figures" } dl { @for pair in pairs { (pair) } } } }
}

/// What a PASS does not cover.
pub(super) fn not_exercised(report: &Report) -> Markup {
    if report.not_exercised.is_empty() {
        return Markup::default();
    }
    html! {
        section {
            h2 { "Not exercised" }
            p { "A fault in one of these would have gone unseen:" }
            ul { @for part in &report.not_exercised { li { (plain(&part.words())) } } }
        }
    }
}

/// What the link did.
pub(super) fn link(link: &LinkReport) -> Markup {
    html! {
        section { h2 { "Link" } dl {
            (pair("Name", &link.name))
            (pair("Bytes", format!("{} out, {} in", grouped(link.bytes_out), grouped(link.bytes_in))))
            (pair("Packets", format!("{} out, {} in", grouped(link.packets_out), grouped(link.packets_in))))
            (pair("Damaged", format!("{} out, {} in", grouped(link.damaged_out), grouped(link.damaged_in))))
            (pair("Sent again", format!("{}; limit {}", grouped(link.retries), grouped(link.retry_limit))))
            @if let Some(late) = wording::late(link) { (pair("Late", late)) }
            @if link.line_errors.sum() > 0 { (pair("Line errors", link.line_errors.to_string())) }
            @if let Some(time) = link.round_trip_us { (pair("Round trip", format!("{} µs", grouped(time)))) }
            (pair("Time", format!("{:.3} s on the link's clock", link.seconds)))
            @for together in link.reconnections.chunk_by(|one, other| wording::away(one) == wording::away(other)) {
                (pair("Went away", wording::away_together(together)))
            }
        } }
    }
}

/// The board and what was uploaded to it.
pub(super) fn board(report: &Report) -> Markup {
    let board = &report.board;
    html! {
        section {
            h2 { "Board" }
            dl {
                (pair("Kind", wording::kind_of(board)))
                (pair("Target", &board.target))
                @match &board.identity {
                    Some(identity) => @for (name, value) in identity.lines() { (pair(name, value)) },
                    None => (pair("identity", wording::UNIDENTIFIED)),
                }
            }
        }
        section { h2 { "Tables" } (tables(&report.tables)) }
    }
}

fn tables(tables: &TablesReport) -> Markup {
    html! {
        dl {
            (pair("Source", &tables.source))
            (pair("Geometry", format!("{} x {}, {} bits", tables.width, tables.height, tables.bits)))
            (pair("Optical centre", format!("column {:.1}", f64::from(tables.centre2) / 2.0)))
            @if let Some(outside) = tables.rows_outside_circle {
                (pair("Rows outside the image circle", grouped(outside)))
            }
            (pair("CRC-32", format!("tables {}, kernel {}", tables.tables_crc32, tables.kernel_crc32)))
        }
    }
}

/// What it takes to repeat the run.
pub(super) fn run(report: &Report) -> Markup {
    let run = &report.run;
    let command: Vec<_> = run.arguments.iter().map(|argument| shell_word(argument)).collect();
    html! {
        section {
            h2 { "Run" }
            pre { (plain(&command.join(" "))) }
            dl {
                (pair("Program", format!("halfrow {} ({})", run.version, run.commit)))
                (pair("Cause", wording::cause(report.cause)))
                (pair("Seed", run.seed.to_string()))
                (pair("Began", &run.started))
                (pair("Ended", &run.ended))
                (pair("Host", &run.host))
            }
            @if !run.files.is_empty() {
                h3 { "Files read" }
                dl.files { @for file in &run.files { (pair(&file.path, format!("SHA-256 {}", file.sha256))) } }
            }
        }
    }
}

/// A term and its value.
pub(super) fn pair(term: &str, value: impl AsRef<str>) -> Markup {
    html! { div { dt { (plain(term)) } dd { (plain(value.as_ref())) } } }
}
