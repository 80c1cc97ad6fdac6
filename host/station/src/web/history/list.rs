//! The list of runs.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;
use halfrow::Verdict;
use maud::{Markup, html};

use super::run_filter::{RunFilter, station_address, unit_address};
use super::show;
use crate::history;
use crate::history::runs::{self, RunLine};
use crate::plan::PlanName;
use crate::store::Snapshot;
use crate::web::fields::Fields;
use crate::web::layout::{Here, Page};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// How many runs a page has.
const RUNS: u32 = 50;

pub(super) async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<RunFilter>,
) -> Result<Response, Trouble> {
    let asking = asked.filter().and_then(|filter| Ok((filter, asked.after()?)));
    let (filter, after) = asking.map_err(|wrong| wrong.told(&visit))?;
    let look = move |now: &Snapshot| {
        Ok((runs::page(now, &filter, after.as_ref(), RUNS)?, history::plan_names(now)?))
    };
    let (found, plans) = app.look(&visit, look).await?;
    let content = html! {
        h1 { (visit.say("history.title")) }
        (form(&visit, &asked, &lanes(&app), &plans))
        @if found.runs.is_empty() {
            p.nothing { (visit.say("history.none")) }
        } @else {
            (table(&visit, &found.runs))
        }
        p.pages {
            @if asked.is_further() {
                a href=(asked.address("/history", None)) { (visit.say("history.newest")) }
            }
            @if let Some(next) = &found.next {
                a rel="next" href=(asked.address("/history", Some(next))) { (visit.say("history.older")) }
            }
            @if !found.runs.is_empty() {
                a.table href=(asked.address("/history.csv", None)) download { (visit.say("history.table")) }
            }
        }
    };
    let page = Page { here: Here::History, title: visit.say("history.title"), head: show::head(), content };
    Ok(page.answer(&visit))
}

/// The names of the lanes that the station has.
pub(super) fn lanes(app: &App) -> Vec<String> {
    app.settings().lanes.iter().map(|lane| lane.name.clone()).collect()
}

fn form(visit: &Visit, asked: &RunFilter, lanes: &[String], plans: &BTreeSet<PlanName>) -> Markup {
    html! {
        form.filters method="get" action="/history" {
            (field(visit.say("history.serial"), "serial", "search", &asked.serial))
            label { span { (visit.say("history.verdict")) }
                select name="verdict" {
                    option value="" { (visit.say("history.any")) }
                    @for word in Verdict::ALL.map(Verdict::name) {
                        option value=(word) selected[asked.verdict.eq_ignore_ascii_case(word)] { (word) }
                    }
                }
            }
            (common(visit, asked, lanes, plans))
            (field(visit.say("history.operator"), "operator", "search", &asked.operator))
            span.acts {
                button { (visit.say("history.show")) }
                " " a href="/history" { (visit.say("history.all")) }
            }
        }
        (asked_for(visit, asked, &[
            (visit.say("history.serial"), &asked.serial),
            (visit.say("history.verdict"), &asked.verdict),
            (visit.say("history.operator"), &asked.operator),
        ]))
    }
}

/// What the form asks for, for paper, where there is no form: the page's `own` fields, and those of every page.
pub(super) fn asked_for(visit: &Visit, asked: &RunFilter, own: &[(&str, &str)]) -> Markup {
    let common: [(&str, &str); 6] = [
        (visit.say("nav.station"), &asked.station),
        (visit.say("history.product"), &asked.product),
        (visit.say("history.plan"), &asked.plan),
        (visit.say("history.lane"), &asked.lane),
        (visit.say("history.from"), &asked.from),
        (visit.say("history.until"), &asked.until),
    ];
    let colon = visit.say("told.colon");
    let told = own.iter().chain(&common).filter(|(_, value)| !value.trim().is_empty());
    let told: Vec<_> = told.map(|(label, value)| format!("{label}{colon}{value}")).collect();
    html! { @if !told.is_empty() { p.asked { (show::said(&told.join(" · "))) } } }
}

/// The fields that runs, yields and failures have in common: a plant's station, product, plan, lane, first and last day.
pub(super) fn common(
    visit: &Visit,
    asked: &RunFilter,
    lanes: &[String],
    plans: &BTreeSet<PlanName>,
) -> Markup {
    let products: BTreeSet<_> = plans.iter().map(|plan| &plan.product).collect();
    html! {
        @if visit.is_plant { (field(visit.say("nav.station"), "station", "search", &asked.station)) }
        label { span { (visit.say("history.product")) }
            input type="search" name="product" value=(asked.product) list="products";
        }
        datalist #products { @for product in products { option value=(product) {} } }
        label { span { (visit.say("history.plan")) }
            input type="search" name="plan" value=(asked.plan) list="plans";
        }
        datalist #plans { @for plan in plans { option value=(plan.plan) { (show::said(&plan.product)) } } }
        label { span { (visit.say("history.lane")) }
            input.short type="search" name="lane" value=(asked.lane) list="lanes";
        }
        datalist #lanes { @for lane in lanes { option value=(lane) {} } }
        (day(visit.say("history.from"), "from", &asked.from))
        (day(visit.say("history.until"), "until", &asked.until))
    }
}

fn field(label: &str, name: &str, kind: &str, value: &str) -> Markup {
    html! { label { span { (label) } input type=(kind) name=(name) value=(value); } }
}

/// A day; a moment that the address names is kept as text.
fn day(label: &str, name: &str, value: &str) -> Markup {
    field(label, name, if value.len() > 10 { "text" } else { "date" }, value)
}

fn table(visit: &Visit, runs: &[RunLine]) -> Markup {
    html! {
        table.runs.cards {
            thead { tr {
                th { (visit.say("history.began")) } th { (visit.say("history.serial")) }
                th { (visit.say("history.verdict")) } th { (visit.say("history.plan")) }
                @if visit.is_plant { th { (visit.say("nav.station")) } }
                th { (visit.say("history.lane")) } th { (visit.say("history.operator")) }
                th { (visit.say("history.result")) }
            } }
            tbody { @for run in runs { (row(visit, run)) } }
        }
    }
}

fn row(visit: &Visit, run: &RunLine) -> Markup {
    html! {
        tr {
            td.when { a href=(show::run_address(&run.id)) { (show::titled_moment(run.started_ms)) } }
            td.serial { a href=(unit_address(&run.serial)) { (show::said(&run.serial)) } }
            td.outcome { (show::outcome(visit, run)) }
            td.plan { (show::said(&run.product)) " " (show::said(&run.plan)) " " (show::said(&run.version)) }
            @if visit.is_plant {
                td.lane { (of_card(visit.say("nav.station"))) a href=(station_address(&run.station)) { (show::said(&run.station)) } }
            }
            td.lane { (of_card(visit.say("history.lane"))) (show::said(&run.lane)) }
            td.operator { (of_card(visit.say("history.operator"))) (show::said(&run.operator)) }
            td.headline { @if let Some(headline) = &run.headline { (show::english(visit, headline)) } }
        }
    }
}

/// What a cell of a card is, whose column is not seen.
fn of_card(label: &str) -> Markup {
    html! { span.of-card { (label) " " } }
}
