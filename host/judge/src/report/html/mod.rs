//! The report as one self-contained page: pictures and style are inside, there is no script, and nothing is loaded.

mod at_speed;
mod charts;
mod evidence;
mod facts;
mod soak;
mod within;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use png::EncodingError;

use super::wording;
use crate::result::wording::{MAPS, NO_MAPS};
use crate::result::{Check, Evidence, Report, Suspect};
use crate::verdict::Verdict;
use crate::words::{board_name, plain};

const STYLE: &str = include_str!("../style.css");

/// Forbids the page to load or run anything, whatever text gets into it.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// The report as a page of under 2 MB for a PASS, and under 4 MB for anything else. Frames of `evidence` have a section with
/// pictures each, as far as there is room. When they are too many, pictures are made smaller, and the last ones are left out.
///
/// # Errors
/// The PNG encoder's.
pub fn render(report: &Report, evidence: &[Evidence]) -> Result<String, EncodingError> {
    let pictures = evidence::sections(report, evidence)?;
    let title = format!("{}: halfrow {} {}", report.verdict(), report.command(), plain(&report.board.target));
    let body = html! {
        (banner(report))
        main {
            (next(report))
            @for lack in wording::lacks(report) { section { p { "Besides, " (lack) "." } } }
            (facts::not_exercised(report))
            section { h2 { "Checks" } (checks(&report.checks)) }
            (at_speed::section(&report.finding))
            (facts::frames(report))
            @if let Some(soak) = &report.soak { (soak::section(soak)) }
            (pictures)
            (facts::figures(report))
            @if let Some(within) = &report.within { (within::section(within)) }
            (facts::link(&report.link))
            (facts::board(report))
            (facts::run(report))
        }
    };
    Ok(document(&title, &body).into_string())
}

/// A page around `body` that contains its style and loads nothing.
pub fn document(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { (body) }
        }
    }
}

/// The verdict and what it rests on: for PASS only the figures, otherwise the headline first.
fn banner(report: &Report) -> Markup {
    html! {
        header.(report.verdict().to_string().to_lowercase()) {
            div {
                p.verdict { (report.verdict()) }
                p.kind { (wording::remark(&report.board)) }
            }
            @if report.verdict() == Verdict::Pass {
                h1 { (wording::facts(report)) }
            } @else {
                h1 { (plain(&report.headline())) }
                p.facts { (wording::facts_below(report)) }
            }
            p.facts {
                (unit(report)) " · " (plain(&report.run.started))
                @if let Some(operator) = &report.run.operator { " · tested by " (plain(operator)) }
            }
        }
    }
}

/// The board: its name, its serial number, and the target by which it was reached.
fn unit(report: &Report) -> Markup {
    let target = plain(&report.board.target);
    html! {
        @match &report.board.identity {
            Some(it) => { (board_name(&it.name)) ", serial " strong { (plain(&it.serial)) } ", at " (target) },
            None => { "a board that did not identify itself, at " (target) },
        }
    }
}

/// The suspects, and what to do.
fn next(report: &Report) -> Markup {
    // Without suspects the remedy is repeated even if the headline says it, because the headline is elsewhere on this page.
    let remedy = wording::remedy(report).or_else(|| report.remedy().filter(|_| report.suspects.is_empty()));
    let bench = wording::technician(report);
    let codes = wording::codes(report);
    let has_maps = report.frames.iter().any(|frame| frame.comparison.differences > 0);
    if codes.is_empty() {
        return Markup::default();
    }
    html! {
        section {
            h2 { "What to do" }
            @if let Some(technician) = &bench { p.remedy { strong { "At the bench: " } (plain(technician)) } }
            @if let Some(remedy) = remedy {
                p.remedy { @if bench.is_some() { strong { "Next: " } } (plain(&asked(&remedy, has_maps))) }
            }
            (suspects(&report.suspects, has_maps))
            p.explain { "More: " code { "halfrow explain " (codes.join(" ")) } }
        }
    }
}

/// The list of suspects, on a page with or without difference maps. An unknown defect is left out where there is a known one.
pub(super) fn suspects(suspects: &[Suspect], has_maps: bool) -> Markup {
    let has_known = suspects.iter().any(Suspect::is_known);
    let shown = |suspect: &&Suspect| suspect.is_known() || !has_known;
    html! {
        @if !suspects.is_empty() {
            ol.suspects { @for it in suspects.iter().filter(shown) { (suspect(it, has_maps)) } }
        }
    }
}

/// What the reader is asked to do, where it refers to the maps in words that suit this page.
fn asked(asked: &str, has_maps: bool) -> String {
    asked.replace(MAPS, if has_maps { "Look at the difference maps below." } else { NO_MAPS })
}

fn suspect(suspect: &Suspect, has_maps: bool) -> Markup {
    html! {
        li {
            h3 {
                (plain(&suspect.place()))
                @if let Some(share) = wording::share(suspect) { span.share { " " (share) } }
            }
            p { (plain(&suspect.evidence())) }
            p { strong { "At the bench: " } (plain(&suspect.technician())) }
            p { strong { "Next: " } (plain(&asked(&suspect.designer(), has_maps))) }
        }
    }
}

fn checks(checks: &[Check]) -> Markup {
    html! {
        table.checks {
            @for check in checks {
                tr {
                    td { (facts::mark(check.outcome)) }
                    th scope="row" { (check.name) }
                    td { (plain(&check.detail())) }
                }
            }
        }
    }
}
