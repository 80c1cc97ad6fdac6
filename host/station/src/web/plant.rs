//! The plant's first page: every station, what two of them bound differently, and the plans that hold.

use axum::extract::State;
use axum::response::Response;
use maud::{Markup, html};

use super::history::{mismatch, show, station_address};
use super::layout::{Here, Page};
use super::routes::{Route, Who, look};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;
use crate::history::mismatch::mismatches;
use crate::history::stations::{Station, ambiguous, stations};
use crate::published::Statement;
use crate::store::publications;

pub(super) fn routes() -> Vec<Route> {
    vec![look("/", Who::Reader, page)]
}

async fn page(State(app): State<App>, visit: Visit) -> Result<Response, Trouble> {
    let (mut found, ambiguous, differing, plans) = app
        .look(&visit, |now| Ok((stations(now)?, ambiguous(now)?, mismatches(now)?, publications(now)?)))
        .await?;
    found.sort_by_key(|station| station.is_there);
    let content = html! {
        h1 { (visit.say("plant.stations")) }
        @if found.is_empty() { p.nothing { (visit.say("plant.none")) } } @else { (table(&visit, &found, &ambiguous)) }
        (mismatch::table(&visit, &differing))
        @if !plans.is_empty() {
            h2 { (visit.say("plant.published")) }
            (published(&visit, &plans))
        }
    };
    let title = visit.say("plant.stations");
    Ok(Page { here: Here::Stations, title, head: show::head(), content }.answer(&visit))
}

fn table(visit: &Visit, stations: &[Station], ambiguous: &[String]) -> Markup {
    let silent = stations.iter().filter(|station| !station.is_there).count();
    let counts = [("silent", &*silent.to_string()), ("all", &stations.len().to_string())];
    html! {
        p.beyond[silent > 0] { (visit.words.fill("plant.silent", &counts)) }
        div.wide tabindex="0" role="region" aria-label=(visit.say("plant.stations")) { table.runs {
            thead { tr {
                th { (visit.say("nav.station")) } th { (visit.say("plant.state")) } th { (visit.say("plant.seen")) }
                th { (visit.say("history.last")) } th.number { (visit.say("outbox.entries")) }
                th { (visit.say("history.plan")) } th { (visit.say("plant.program")) }
            } }
            tbody { @for station in stations { (row(visit, station, ambiguous)) } }
        } }
    }
}

/// The plans that hold.
fn published(visit: &Visit, plans: &[(Statement, i64)]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("plant.published")) { table.runs {
            thead { tr {
                th { (visit.say("history.plan")) } th { (visit.say("plant.version")) }
                th.number { (visit.say("plant.number")) } th { (visit.say("outbox.since")) }
                th { (visit.say("plant.by")) } th { (visit.say("plant.why")) }
            } }
            tbody { @for (statement, at_ms) in plans {
                tr {
                    td.name { (show::said(&statement.product)) " " (show::said(&statement.name)) }
                    td { b { (show::said(&statement.version)) } } td.number { (statement.number) }
                    td.when { (show::titled_moment(*at_ms)) } td { (show::said(&statement.operator)) }
                    td.headline { (show::said(&statement.reason)) }
                }
            } }
        } }
    }
}

fn row(visit: &Visit, station: &Station, ambiguous: &[String]) -> Markup {
    html! {
        tr {
            td.name { a href=(station_address(&station.name)) { b { (show::said(&station.name)) } } }
            td {
                @if station.is_there { "● " (visit.say("plant.there")) } @else { "○ " (visit.say("plant.away")) }
            }
            td.when { (show::titled_moment(station.seen_ms)) }
            td.when { @if let Some(last_ms) = station.last_ms { (show::moment(last_ms)) } }
            td.number {
                (station.unsent)
                @if station.dead > 0 { " " span.few { (visit.say("outbox.waits")) " " (station.dead) } }
            }
            td { @for plan in &station.plans {
                div {
                    (show::said(plan))
                    @if ambiguous.contains(plan) { " " span.few { (visit.say("plant.ambiguous")) } }
                }
            } }
            td.soft { (show::said(&station.program)) }
        }
    }
}
