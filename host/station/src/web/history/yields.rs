//! First-pass and final yield.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;
use clap::ValueEnum;
use maud::{Markup, html};

use super::bars::Day;
use super::run_filter::{RunFilter, unit_address};
use super::{bars, list, show};
use crate::history;
use crate::history::drift::{Drift, drifts};
use crate::history::rate::Rate;
use crate::history::yields::{self, By, Flip, Yield, Yields};
use crate::plan::PlanName;
use crate::store::Snapshot;
use crate::web::fields::Fields;
use crate::web::layout::{Here, Page};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The most flips that are listed.
const MOST_FLIPS: usize = 200;
/// The most days that are drawn.
const MOST_DAYS: usize = 60;
/// The most lines that are listed.
const MOST_LINES: usize = 120;
/// The least chance that is told as it is.
const LEAST_CHANCE: f64 = 1e-15;
/// With fewer units a share says little.
pub(super) const FEW: u64 = 30;

pub(super) async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<RunFilter>,
) -> Result<Response, Trouble> {
    let asking = asked.wanted().and_then(|wanted| Ok((wanted, asked.by()?)));
    let (wanted, by) = asking.map_err(|wrong| wrong.told(&visit))?;
    let look = move |now: &Snapshot| Ok((yields::yields(now, &wanted, by)?, history::plan_names(now)?));
    let (Yields { mut lines, mut flips }, plans) = app.look(&visit, look).await?;
    // The newest day first; lane 10 after lane 9.
    let lane = |line: &Yield| line.lane.as_ref().map(|lane| (lane.len(), lane.clone()));
    lines.sort_by_cached_key(|line| {
        (line.plan.clone(), std::cmp::Reverse(line.day.or(line.week)), line.station.clone(), lane(line))
    });
    flips.sort_by_key(|flip| std::cmp::Reverse(flip.passed_ms));
    let content = html! {
        h1 { (visit.say("yield.title")) }
        p.soft { (visit.say("yield.about")) }
        (form(&visit, ("/yield", by, word), &asked, &list::lanes(&app), &plans))
        @if lines.is_empty() {
            p.nothing { (visit.say("history.none")) }
        } @else {
            @if matches!(by, By::Day | By::Week) { (drawn(&visit, &lines)) }
            @if by == By::Station { (drifting(&visit, &asked, &drifts(&lines))) }
            (table(&visit, by, &asked, &lines))
        }
        (flipped(&visit, &flips))
    };
    let page = Page { here: Here::Yield, title: visit.say("yield.title"), head: show::head(), content };
    Ok(page.answer(&visit))
}

/// The form of the page at `address`, which has a line for each `by`, and on paper what it was asked for.
pub(super) fn form<T: Copy + ValueEnum + PartialEq>(
    visit: &Visit,
    (address, by, word): (&str, T, fn(&Visit, T) -> &'static str),
    asked: &RunFilter,
    lanes: &[String],
    plans: &BTreeSet<PlanName>,
) -> Markup {
    html! {
        form.filters method="get" action=(address) {
            (choice(visit, by, word))
            (list::common(visit, asked, lanes, plans))
            span.acts { button { (visit.say("history.show")) } " " a href=(address) { (visit.say("history.all")) } }
        }
        (list::asked_for(visit, asked, &[(visit.say("history.by"), word(visit, by))]))
    }
}

/// The choice of what there is a line for.
fn choice<T: Copy + ValueEnum + PartialEq>(
    visit: &Visit,
    by: T,
    word: fn(&Visit, T) -> &'static str,
) -> Markup {
    let all = T::value_variants().iter().filter_map(|one| Some((*one, one.to_possible_value()?)));
    html! {
        label { span { (visit.say("history.by")) }
            select name="by" {
                @for (one, value) in all { option value=(value.get_name()) selected[one == by] { (word(visit, one)) } }
            }
        }
    }
}

fn word(visit: &Visit, by: By) -> &'static str {
    match by {
        By::Plan => visit.say("history.plan"),
        By::Day => visit.say("yield.day"),
        By::Week => visit.say("yield.week"),
        By::Lane => visit.say("history.lane"),
        By::Station => visit.say("nav.station"),
    }
}

/// First pass by day, the plans one below the other.
fn drawn(visit: &Visit, lines: &[Yield]) -> Markup {
    let (first, colon) = (visit.say("yield.first"), visit.say("told.colon"));
    html! {
        @for of_plan in lines.chunk_by(|one, other| one.plan == other.plan) {
            @let PlanName { product, plan } = &of_plan[0].plan;
            @let title = format!("{first}{colon}{product} {plan}");
            figure.days {
                figcaption { (show::said(&title)) }
                div.wide tabindex="0" role="region" aria-label=(show::said(&title)) { (bars::days(visit, first, &named_days(visit, of_plan))) }
                (beyond(visit, of_plan))
            }
        }
    }
}

/// What the band means, and the days or weeks that are beyond it.
fn beyond(visit: &Visit, of_plan: &[Yield]) -> Markup {
    let is_beyond = |line: &&Yield| line.limits.is_some_and(|limits| limits.is_beyond);
    let days: Vec<_> = of_plan.iter().filter(is_beyond).take(MOST_LINES).map(began).collect();
    html! {
        p.soft {
            (visit.say("yield.band"))
            @if of_plan.len() > MOST_DAYS {
                " " (visit.words.fill("yield.drawn", &[("columns", &MOST_DAYS.to_string())]))
            }
        }
        @if !days.is_empty() { p.beyond { (visit.words.fill("yield.beyond", &[("days", &days.join(visit.say("told.list")))])) } }
    }
}

/// The day of a line, or the first one of its week.
fn began(line: &Yield) -> String {
    line.day.or(line.week).map(|day| day.to_string()).unwrap_or_default()
}

/// The newest days of a plan, the earliest of them first. The lines begin with the newest day.
fn named_days(visit: &Visit, of_plan: &[Yield]) -> Vec<Day> {
    let named = |line: &Yield| {
        let name = began(line);
        let said = format!("{name}: {}", visit.words.figures(&line.first_pass.text()));
        Day { name, said, rate: line.first_pass, limits: line.limits }
    };
    of_plan.iter().take(MOST_DAYS).rev().map(named).collect()
}

/// Stations that judge differently from all others.
fn drifting(visit: &Visit, asked: &RunFilter, drifts: &[Drift]) -> Markup {
    let marked: Vec<_> = drifts.iter().filter(|drift| drift.is_marked).collect();
    let compared = drifts.iter().filter(|drift| drift.chance.is_some()).count();
    let counts = [("compared", &*compared.to_string()), ("all", &drifts.len().to_string())];
    html! {
        @if !drifts.is_empty() {
            p.soft { (visit.say("yield.drift_about")) }
            @if compared == 0 { p { (visit.say("yield.uncompared")) } } @else {
                p {
                    @if marked.is_empty() { (visit.say("yield.no_drift")) " " }
                    (visit.words.fill("yield.compared", &counts))
                }
            }
            @for Drift { plan, station, here, elsewhere, chance, .. } in marked {
                p.beyond {
                    (station_link(visit, asked, station, plan)) " · " (show::said(&plan.product)) " " (show::said(&plan.plan)) (visit.say("told.colon"))
                    (show::share(visit, here)) " " span.soft { (show::of(here)) } " · "
                    (visit.say("yield.elsewhere")) " " (show::share(visit, elsewhere)) " " span.soft { (show::of(elsewhere)) }
                    @if let Some(chance) = chance { " · p " (visit.words.figures(&chance_text(*chance))) }
                }
            }
        }
    }
}

/// A chance for people. It is never told to be nought, as far smaller ones come out.
fn chance_text(chance: f64) -> String {
    if chance < LEAST_CHANCE { format!("< {LEAST_CHANCE:e}") } else { format!("= {chance:.1e}") }
}

fn table(visit: &Visit, by: By, asked: &RunFilter, lines: &[Yield]) -> Markup {
    let mut of = vec![word(visit, by)];
    of.extend((by != By::Plan).then(|| word(visit, By::Plan)));
    let of = of.join(visit.say("told.list"));
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("yield.title")) { table.yields {
            thead { tr {
                th { (of) } th.number { (visit.say("yield.units")) }
                th { (visit.say("yield.first")) } th { (visit.say("yield.last")) }
                th.number { (visit.say("yield.flipped")) } th.number { (visit.say("yield.waived")) }
                th.number { (visit.say("history.runs")) } th { (visit.say("yield.errors")) }
                th.number { (visit.say("yield.crashes")) }
            } }
            tbody { @for line in lines.iter().take(MOST_LINES) { (row(visit, asked, line)) } }
        } }
        @if lines.len() > MOST_LINES { p.soft { (visit.say("yield.narrow")) } }
    }
}

fn row(visit: &Visit, asked: &RunFilter, line: &Yield) -> Markup {
    let Yield { plan, first_pass, last, errors, .. } = line;
    html! {
        tr {
            td.name {
                @if let Some(day) = line.day.or(line.week) { b { (day) } " " }
                @if let Some(station) = line.station.as_ref().filter(|_| visit.is_plant || line.lane.is_none()) {
                    (station_link(visit, asked, station, plan)) " "
                }
                @if let Some(lane) = &line.lane {
                    b { (visit.say("history.lane")) " " (show::said(lane)) } " "
                }
                span.soft { (show::said(&plan.product)) " " (show::said(&plan.plan)) }
            }
            td.number { (first_pass.of) }
            td { (bars::share(first_pass)) (rate(visit, first_pass)) }
            td { (bars::share(last)) (rate(visit, last)) }
            td.number { (line.flipped) }
            td.number { (line.waived) }
            td.number { (errors.of) }
            td { div.rate { (show::share(visit, errors)) " " span.soft { (show::of(errors)) } } }
            td.number { (line.crashes) }
        }
    }
}

/// A station, which leads to its runs where there are several stations.
fn station_link(visit: &Visit, asked: &RunFilter, station: &str, plan: &PlanName) -> Markup {
    let name = html! { b { (show::said(station)) } };
    html! { @if visit.is_plant { a href=(asked.address_of(station, plan)) { (name) } } @else { (name) } }
}

/// A share with its interval and its counts, and a word where the units are few.
fn rate(visit: &Visit, rate: &Rate) -> Markup {
    html! {
        div.rate {
            (show::share(visit, rate)) " " span.soft { (show::of(rate)) }
            @if rate.of > 0 && rate.of < FEW { " " span.few { (visit.say("yield.few")) } }
        }
    }
}

fn flipped(visit: &Visit, flips: &[Flip]) -> Markup {
    let title = visit.words.fill("yield.flips", &[("units", &flips.len().to_string())]);
    html! {
        h2 { (title) }
        @if flips.is_empty() { p.soft { (visit.say("yield.no_flips")) } } @else {
            p.soft { (visit.say("yield.flips_about")) }
            div.wide tabindex="0" role="region" aria-label=(title) { table.flips {
                thead { tr {
                    th { (visit.say("history.serial")) } th { (visit.say("history.plan")) }
                    th { "FAIL" } th { "PASS" } th.number { (visit.say("yield.judgements")) }
                } }
                tbody { @for flip in flips.iter().take(MOST_FLIPS) { (flip_row(flip)) } }
            } }
            @if flips.len() > MOST_FLIPS { p.soft { (visit.say("yield.narrow")) } }
        }
    }
}

fn flip_row(flip: &Flip) -> Markup {
    html! {
        tr {
            td.serial { a href=(unit_address(&flip.serial)) { (show::said(&flip.serial)) } }
            td { (show::said(&flip.plan.product)) " " (show::said(&flip.plan.plan)) }
            td { a href=(show::run_address(&flip.failed)) { (show::moment(flip.failed_ms)) } }
            td { a href=(show::run_address(&flip.passed)) { (show::moment(flip.passed_ms)) } }
            td.number { (flip.judgements) }
        }
    }
}
