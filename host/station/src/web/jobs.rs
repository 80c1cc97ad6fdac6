//! The plant's jobs, and the boards that are shared: who has them, and who waits.

use axum::extract::State;
use axum::response::Response;
use maud::{Markup, html};
use serde::Deserialize;
use strum::VariantArray as _;

use super::fields::Fields;
use super::history::{show, unit_address};
use super::layout::{Here, Page};
use super::routes::{Route, Who, look};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;
use crate::store::{Job, JobState, SharedBoard, Waiting, boards, jobs, waiters};

/// How many jobs a page has.
const MOST: u32 = 100;

pub(super) fn routes() -> Vec<Route> {
    vec![look("/jobs", Who::Reader, page)]
}

/// Which jobs are asked for.
#[derive(Default, Deserialize)]
#[serde(default)]
struct JobFilter {
    /// Only those in this state; all if it is no state.
    state: String,
    /// Only those that were added before this one.
    after: String,
}

async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<JobFilter>,
) -> Result<Response, Trouble> {
    let chosen: Option<JobState> = asked.state.parse().ok();
    let states = chosen.map_or_else(|| JobState::VARIANTS.to_vec(), |state| vec![state]);
    let after = asked.after.clone();
    let found = app
        .look(&visit, move |now| Ok((jobs(now, &states, &after, MOST)?, boards(now)?, waiters(now)?)))
        .await?;
    let (jobs, boards, waiting) = found;
    let content = html! {
        h1 { (visit.say("jobs.title")) }
        (states_to_choose(&visit, chosen))
        @if jobs.is_empty() { p.nothing { (visit.say("jobs.none")) } } @else { (table(&visit, &jobs)) }
        @if let Some(last) = jobs.last().filter(|_| jobs.len() == MOST as usize) {
            p { a href=(format!("/jobs?state={}&after={}", chosen.map(|state| state.to_string()).unwrap_or_default(), last.id)) { (visit.say("jobs.more")) } }
        }
        h2 { (visit.say("jobs.boards")) }
        @if boards.is_empty() { p.nothing { (visit.say("jobs.no_boards")) } } @else { (shelf(&visit, &boards)) }
        @if !waiting.is_empty() { (queue(&visit, &waiting)) }
    };
    let title = visit.say("jobs.title");
    Ok(Page { here: Here::Jobs, title, head: show::head(), content }.answer(&visit))
}

/// A link for each state and one for all.
fn states_to_choose(visit: &Visit, chosen: Option<JobState>) -> Markup {
    html! {
        p {
            a href="/jobs" aria-current=[chosen.is_none().then_some("true")] { (visit.say("jobs.all")) }
            @for &state in JobState::VARIANTS {
                " · "
                a href=(format!("/jobs?state={state}")) aria-current=[(chosen == Some(state)).then_some("true")] {
                    (state_word(visit, state))
                }
            }
        }
    }
}

fn state_word(visit: &Visit, state: JobState) -> &'static str {
    match state {
        JobState::Waiting => visit.say("jobs.waiting"),
        JobState::Claimed => visit.say("jobs.claimed"),
        JobState::Done => visit.say("jobs.done"),
        JobState::Dead => visit.say("jobs.dead"),
    }
}

fn table(visit: &Visit, jobs: &[Job]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("jobs.title")) { table.runs {
            thead { tr {
                th { (visit.say("jobs.added")) } th { (visit.say("jobs.board")) } th { (visit.say("history.plan")) }
                th.number { (visit.say("jobs.priority")) } th { (visit.say("plant.state")) }
                th.number { (visit.say("jobs.claims")) } th { (visit.say("outbox.said")) }
            } }
            tbody { @for job in jobs { (row(visit, job)) } }
        } }
    }
}

fn row(visit: &Visit, job: &Job) -> Markup {
    html! {
        tr {
            td.when title=(job.id) { (show::titled_moment(job.created_ms)) }
            td {
                @if job.serial.is_empty() { (visit.say("jobs.any")) " " (show::said(&job.kind)) }
                @else { (unit(&job.serial)) }
                @if !job.needs.is_empty() { div.soft { (show::said(&job.needs)) } }
            }
            td { (show::said(&job.plan)) " " (show::said(&job.version)) }
            td.number { (job.priority) }
            td {
                @match (&job.run, &job.verdict) {
                    (Some(run), verdict) => { a href=(show::run_address(run)) { (show::verdict(visit, *verdict)) } }
                    (None, _) => { (state_word(visit, job.state)) }
                }
                @if let Some(holder) = &job.holder { div.soft { (show::said(holder)) } }
            }
            td.number { (job.attempts) }
            td.headline { @if let Some(said) = &job.said { (show::english(visit, said)) } }
        }
    }
}

/// A serial number, which leads to the runs of its unit: a job that came to nothing has no run of its own to lead to.
fn unit(serial: &str) -> Markup {
    html! { a href=(unit_address(serial)) { (show::said(serial)) } }
}

fn shelf(visit: &Visit, boards: &[SharedBoard]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("jobs.boards")) { table.runs {
            thead { tr {
                th { (visit.say("jobs.board")) } th { (visit.say("jobs.kind")) } th { (visit.say("jobs.place")) }
                th { (visit.say("history.serial")) } th { (visit.say("nav.station")) } th { (visit.say("plant.state")) }
            } }
            tbody { @for board in boards {
                tr {
                    td.name { b { (show::said(&board.name)) } }
                    td { (show::said(&board.kind)) } td { (show::said(&board.target)) }
                    td { @if !board.serial.is_empty() { (unit(&board.serial)) } } td { (show::said(&board.station)) }
                    td { (state(visit, board)) }
                }
            } }
        } }
    }
}

fn state(visit: &Visit, board: &SharedBoard) -> Markup {
    html! {
        @match (&board.out, &board.holder) {
            (Some(why), _) => { "– " (visit.say("jobs.out")) ": " (show::english(visit, why)) }
            (None, Some(holder)) => {
                "● " (show::said(holder))
                @if let Some(until_ms) = board.until_ms { div.soft { (visit.say("jobs.until")) " " (show::moment(until_ms)) } }
            }
            (None, None) => { "○ " (visit.say("jobs.free")) }
        }
    }
}

/// Who waits, in the order of the queue.
fn queue(visit: &Visit, waiting: &[Waiting]) -> Markup {
    html! {
        h2 { (visit.say("jobs.queue")) }
        ol { @for Waiting { kind, holder, since_ms } in waiting {
            li { (show::said(kind)) ": " (show::said(holder)) ", " (visit.say("jobs.since")) " " (show::moment(*since_ms)) }
        } }
    }
}
