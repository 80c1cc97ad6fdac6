//! The plant's jobs, and the boards that are shared: who has them, and who waits.

use std::collections::BTreeSet;

use axum::extract::State;
use axum::response::Response;
use maud::{Markup, html};
use serde::Deserialize;
use strum::VariantArray as _;
use uuid::Uuid;

use super::fields::Fields;
use super::history::{show, unit_address};
use super::layout::{Here, Page};
use super::routes::{Route, Who, look};
use super::state::App;
use super::trouble::Trouble;
use super::visit::Visit;
use crate::store::{
    Job, JobState, SharedBoard, Snapshot, StoreError, Waiting, boards, counted_jobs, jobs, seen_units,
    waiters,
};

/// How many jobs a page has.
const MOST: u32 = 100;
/// The state that stands for those in which something is still to be done.
const UNSETTLED: &str = "";
/// The state that stands for all.
const ALL: &str = "all";

pub(super) fn routes() -> Vec<Route> {
    vec![look("/jobs", Who::Reader, page)]
}

/// Which jobs are asked for.
#[derive(Default, Deserialize)]
#[serde(default)]
struct JobFilter {
    /// Only those in this state, or all; those that are not settled if it is empty.
    state: String,
    /// Only those that were added before this one.
    after: String,
}

impl JobFilter {
    /// The states, or the value that cannot be searched for.
    fn states(&self) -> Result<Vec<JobState>, &str> {
        if !self.after.is_empty() && Uuid::parse_str(&self.after).is_err() {
            return Err(&self.after);
        }
        match &*self.state {
            UNSETTLED => Ok(JobState::UNSETTLED.to_vec()),
            ALL => Ok(JobState::VARIANTS.to_vec()),
            state => state.parse().map(|state| vec![state]).map_err(|_| state),
        }
    }
}

async fn page(
    State(app): State<App>,
    visit: Visit,
    Fields(asked): Fields<JobFilter>,
) -> Result<Response, Trouble> {
    let wrong = |value| Trouble::wrong(&visit, visit.words.fill("history.wrong", &[("value", value)]));
    let (states, after) = (asked.states().map_err(wrong)?, asked.after.clone());
    let Shown { jobs, is_more, counted, boards, waiting, seen } =
        app.look(&visit, move |now| shown(now, &states, &after)).await?;
    let title = visit.say("jobs.title");
    let content = html! {
        h1 { (title) }
        h2 { (visit.say("jobs.boards")) }
        @if boards.is_empty() { (nothing(visit.say("jobs.no_boards"))) } @else { (shelf(&visit, &boards, &seen)) }
        @if !waiting.is_empty() { (queue(&visit, &waiting)) }
        h2 { (visit.say("jobs.listed")) }
        (states_to_choose(&visit, &asked.state, &counted))
        @if jobs.is_empty() { (nothing(visit.say("jobs.none"))) } @else { (table(&visit, &jobs, &seen)) }
        @if let Some(last) = jobs.last().filter(|_| is_more) {
            p { a href=(format!("/jobs?state={}&after={}", asked.state, last.id)) { (visit.say("jobs.more")) } }
        }
    };
    Ok(Page { here: Here::Jobs, title, head: show::head(), content }.answer(&visit))
}

/// That there is nothing, with the command that changes it between backticks.
fn nothing(words: &str) -> Markup {
    html! {
        p.nothing {
            @for (nth, part) in words.split('`').enumerate() { @if nth % 2 == 1 { code { (part) } } @else { (part) } }
        }
    }
}

/// What the page shows.
struct Shown {
    jobs: Vec<Job>,
    /// Whether older ones follow.
    is_more: bool,
    counted: Vec<(JobState, u32)>,
    boards: Vec<SharedBoard>,
    waiting: Vec<Waiting>,
    seen: BTreeSet<String>,
}

fn shown(now: &Snapshot, states: &[JobState], after: &str) -> Result<Shown, StoreError> {
    let (mut jobs, boards) = (jobs(now, states, after, MOST + 1)?, boards(now)?);
    let is_more = jobs.len() > MOST as usize;
    jobs.truncate(MOST as usize);
    let of_jobs = jobs.iter().map(|job| job.serial.as_str());
    let serials: Vec<_> = of_jobs.chain(boards.iter().map(|board| board.serial.as_str())).collect();
    let seen = seen_units(now, &serials)?;
    Ok(Shown { jobs, is_more, counted: counted_jobs(now)?, boards, waiting: waiters(now)?, seen })
}

/// A link for what is not settled, one for each state and one for all, with how many jobs each shows.
fn states_to_choose(visit: &Visit, chosen: &str, counted: &[(JobState, u32)]) -> Markup {
    let jobs = |states: &[JobState]| -> u32 {
        counted.iter().filter(|(state, _)| states.contains(state)).map(|(_, jobs)| jobs).sum()
    };
    let mut choices = vec![(UNSETTLED.to_owned(), visit.say("jobs.unsettled"), jobs(&JobState::UNSETTLED))];
    let of_state = |&state: &JobState| (state.to_string(), state_word(visit, state), jobs(&[state]));
    choices.extend(JobState::VARIANTS.iter().map(of_state));
    choices.push((ALL.to_owned(), visit.say("jobs.all"), jobs(JobState::VARIANTS)));
    html! {
        p {
            @for (nth, (state, word, jobs)) in choices.iter().enumerate() {
                @if nth > 0 { " · " }
                a href=(format!("/jobs?state={state}")) aria-current=[(state == chosen).then_some("true")] { (word) }
                " " (jobs)
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
        JobState::Cancelled => visit.say("jobs.cancelled"),
    }
}

fn table(visit: &Visit, jobs: &[Job], seen: &BTreeSet<String>) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(visit.say("jobs.listed")) { table.runs {
            thead { tr {
                th { (visit.say("jobs.added")) } th { (visit.say("jobs.board")) } th { (visit.say("history.plan")) }
                th.number { (visit.say("jobs.priority")) } th { (visit.say("plant.state")) }
                th.number { (visit.say("jobs.claims")) } th { (visit.say("outbox.said")) }
            } }
            tbody { @for job in jobs { (row(visit, job, seen)) } }
        } }
    }
}

fn row(visit: &Visit, job: &Job, seen: &BTreeSet<String>) -> Markup {
    html! {
        tr {
            td.when title=(job.id) { (show::titled_moment(job.created_ms)) div.soft { (show::said(&job.operator)) } }
            td {
                @if job.serial.is_empty() { (visit.say("jobs.any")) " " (show::said(&job.kind)) }
                @else { (unit(&job.serial, seen)) }
                @if !job.needs.is_empty() { div.soft { (show::said(&job.needs)) } }
            }
            td { (show::said(&job.product)) " " (show::said(&job.plan)) " " (show::said(&job.version)) }
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

/// A serial number, which leads to the runs of its unit if it has any: a job that came to nothing has no run of its own to lead to.
fn unit(serial: &str, seen: &BTreeSet<String>) -> Markup {
    html! {
        @if seen.contains(serial) { a href=(unit_address(serial)) { (show::said(serial)) } } @else { (show::said(serial)) }
    }
}

fn shelf(visit: &Visit, boards: &[SharedBoard], seen: &BTreeSet<String>) -> Markup {
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
                    td { (unit(&board.serial, seen)) } td { (show::said(&board.station)) }
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
