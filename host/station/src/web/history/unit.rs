//! All that is known of a serial number.

use std::collections::BTreeMap;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use halfrow::Verdict;
use halfrow::words::plain;
use maud::{Markup, html};

use super::acts::{Rebind, RefusedAct};
use super::run_filter::RunFilter;
use super::{acts, mismatch, show};
use crate::history::unit::{self, Binding, Unit, UnitRun};
use crate::said::Said;
use crate::store::Snapshot;
use crate::web::fields::Fields;
use crate::web::layout::{Here, Page};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The suspects of runs, by the run's id.
type Defects = BTreeMap<String, Vec<Said>>;

/// The most runs that are shown; a unit that checks shifts has thousands.
const MOST_RUNS: usize = 200;

/// The most records that are read for a page.
const MOST_RECORDS: usize = 20;

pub(super) async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<RunFilter>,
) -> Result<Response, Trouble> {
    shown(app, visit, asked, None).await
}

/// The page, with the reason why an act on it was refused, if one was.
pub(super) async fn shown(
    app: App,
    visit: Visit,
    asked: RunFilter,
    refused: Option<RefusedAct<Rebind>>,
) -> Result<Response, Trouble> {
    if asked.serial.is_empty() {
        return Err(Trouble::missing(&visit));
    }
    let serial = asked.serial.clone();
    let is_english = visit.words.code == "en";
    let look = move |now: &Snapshot| {
        let units = unit::units(now, &serial)?;
        let told = if is_english { Defects::new() } else { told(now, &units) };
        Ok((units, told))
    };
    let (units, told) = app.look(&visit, look).await?;
    if units.is_empty() {
        let said = visit.words.fill("history.unknown", &[("serial", &plain(&asked.serial))]);
        return Err(Trouble::new(&visit, StatusCode::NOT_FOUND, said));
    }
    let status = refused.as_ref().map_or(StatusCode::OK, |refused| refused.status);
    let content = html! {
        @if let Some(refused) = &refused { (refused.markup()) }
        @for unit in &units { (of(&visit, &asked, (unit, &told), refused.as_ref())) }
    };
    let page = Page { here: Here::History, title: &asked.serial, head: show::head(), content };
    Ok(page.with_status(&visit, status))
}

/// The suspects of the newest runs that have some, with their codes: the tables have them in English alone, as older runs keep them.
fn told(now: &Snapshot, units: &[Unit]) -> Defects {
    let shown = units.iter().flat_map(|unit| unit.runs.iter().take(MOST_RUNS));
    let of_run = |run: &UnitRun| {
        let (record, _) = now.record(run.line.record_sha256.as_ref()?).ok()?;
        Some((run.line.id.clone(), super::run::defects(&record)))
    };
    shown.filter(|run| !run.suspects.is_empty()).take(MOST_RECORDS).filter_map(of_run).collect()
}

fn of(
    visit: &Visit,
    asked: &RunFilter,
    (unit, told): (&Unit, &Defects),
    refused: Option<&RefusedAct<Rebind>>,
) -> Markup {
    let more = unit.runs.len().saturating_sub(MOST_RUNS);
    html! {
        section.unit {
            h1 { (show::said(&unit.serial)) " " small { (show::said(&unit.product)) } }
            dl.facts {
                @if let Some(newest) = unit.runs.iter().find(|run| run.line.verdict.is_some()) {
                    (show::pair(visit.say("history.last"), show::outcome(visit, &newest.line)))
                }
                (show::pair(visit.say("history.seen"), show::moment(unit.first_seen_ms)))
                (show::pair(visit.say("history.runs"), unit.runs.len()))
            }
            (flips(visit, unit))
            (devices(visit, &unit.bindings))
            (mismatch::table(visit, &unit.mismatches))
            (acts::rebind_form(visit, unit, refused))
            h2 { (visit.say("history.every")) }
            ol.story { @for run in unit.runs.iter().take(MOST_RUNS) { (story(visit, run, told.get(&run.line.id).map_or(&[], Vec::as_slice))) } }
            @if more > 0 {
                p.pages { a href=(asked.address("/history", None)) { (visit.words.fill("history.further", &[("more", &more.to_string())])) } }
            }
        }
    }
}

/// The plans under which the unit first failed and passed in the end.
fn flips(visit: &Visit, unit: &Unit) -> Markup {
    let judged = |run: &&UnitRun| run.line.is_judgement();
    let mut plans: Vec<_> = unit.runs.iter().filter(judged).map(|run| run.line.plan.as_str()).collect();
    plans.sort_unstable();
    plans.dedup();
    let verdict_of = |run: Option<&&UnitRun>| run.and_then(|run| run.line.verdict);
    let is_flip = |plan: &&str| {
        let of_plan: Vec<_> = unit.runs.iter().filter(judged).filter(|run| run.line.plan == *plan).collect();
        [of_plan.last(), of_plan.first()].map(verdict_of) == [Some(Verdict::Fail), Some(Verdict::Pass)]
    };
    html! {
        @for plan in plans.into_iter().filter(is_flip) {
            p.flip { (show::said(&visit.words.fill("history.flipped_plan", &[("plan", plan)]))) }
        }
    }
}

fn devices(visit: &Visit, bindings: &[Binding]) -> Markup {
    html! {
        @if !bindings.is_empty() {
            h2 { (visit.say("history.devices")) }
            div.wide tabindex="0" role="region" aria-label=(visit.say("history.devices")) { table.bindings {
                thead { tr {
                    th { (visit.say("history.device")) } th { (visit.say("history.from")) }
                    th { (visit.say("history.to")) } th { (visit.say("history.operator")) }
                    th { (visit.say("history.reason")) }
                } }
                tbody { @for one in bindings { tr {
                    td { code { (one.device) } }
                    td { (show::moment(one.from_ms)) }
                    td { @if let Some(to) = one.to_ms { (show::moment(to)) } @else { (visit.say("history.holds")) } }
                    td { (show::said(&one.operator)) }
                    td { (show::said(&one.reason)) }
                } } }
            } }
        }
    }
}

/// A run in the story of its unit.
fn story(visit: &Visit, run: &UnitRun, defects: &[Said]) -> Markup {
    let line = &run.line;
    html! {
        li {
            p.line {
                (show::outcome(visit, line)) " "
                a href=(show::run_address(&line.id)) { (show::moment(line.started_ms)) }
                span.soft {
                    " · " (show::said(&line.plan)) " " (show::said(&line.version))
                    @if visit.is_plant { " · " (visit.say("nav.station")) " " (show::said(&line.station)) }
                    " · " (visit.say("history.lane")) " " (show::said(&line.lane)) " · " (show::said(&line.operator))
                    @if line.is_judgement() {
                        " · " (visit.words.fill("history.nth", &[("number", &line.nth.to_string())]))
                    }
                    @if line.is_uncounted() { " · " (visit.say("run.uncounted")) }
                }
            }
            @if let Some(headline) = &line.headline { p { (show::english(visit, headline)) } }
            @for (place, suspect) in run.suspects.iter().enumerate() { (super::run::suspect(visit, suspect, defects.get(place))) }
            @for waiver in &run.waivers { (super::run::waiver(visit, waiver)) }
        }
    }
}
