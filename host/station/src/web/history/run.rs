//! One run: its verdict and all that this is based on.

use std::time::Duration;

use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::Response;
use clap::ValueEnum as _;
use halfrow::Verdict;
use maud::{Markup, html};
use serde::Deserialize as _;
use serde_json::Value;

use super::acts::{RefusedAct, Waive};
use super::evidence::Whereabouts;
use super::run_filter::unit_address;
use super::{acts, pictures, show};
use crate::export::Format;
use crate::history::unit::{self as history, UnitRun};
use crate::plan::limits::Blame;
use crate::record::{Attachment, DeviceSeen, Measured, MeasuredOutcome, Record, StepOutcome, StepRecord};
use crate::said::Said;
use crate::store::{Snapshot, Waiver};
use crate::web::layout::{Here, Page};
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// A run, its record or why that cannot be read, and its attachments, each with where it is.
struct Found {
    run: UnitRun,
    record: Option<Result<Box<Record>, Said>>,
    kept: Vec<(Attachment, Whereabouts)>,
}

pub(super) async fn page(
    State(app): State<App>,
    visit: Visit,
    Path(id): Path<String>,
) -> Result<Response, Trouble> {
    shown(app, visit, id, None).await
}

/// The page, with the reason why an act on it was refused, if one was.
pub(super) async fn shown(
    app: App,
    visit: Visit,
    id: String,
    refused: Option<RefusedAct<Waive>>,
) -> Result<Response, Trouble> {
    let look = move |now: &Snapshot| {
        let Some(mut run) = history::run_of(now, &id)? else { return Ok(None) };
        let read = |hash: &String| match now.record(hash) {
            Ok((record, _)) => Ok(Box::new(record)),
            Err(error) => Err(Said::of(&error)),
        };
        let record = run.line.record_sha256.as_ref().map(read);
        let kept = Whereabouts::of(now, &id, std::mem::take(&mut run.attachments))?;
        Ok(Some(Found { run, record, kept }))
    };
    let found = app.look(&visit, look).await?.ok_or_else(|| Trouble::missing(&visit))?;
    let status = refused.as_ref().map_or(StatusCode::OK, |refused| refused.status);
    let content = html! {
        @if let Some(refused) = &refused { (refused.markup()) }
        (content(&visit, &found, refused.as_ref()))
    };
    let verdict = found.run.line.verdict.map(|verdict| verdict.to_string());
    let title = format!("{} {}", found.run.line.serial, verdict.unwrap_or_default());
    Ok(Page { here: Here::History, title: &title, head: show::head(), content }.with_status(&visit, status))
}

fn content(
    visit: &Visit,
    Found { run, record, kept }: &Found,
    refused: Option<&RefusedAct<Waive>>,
) -> Markup {
    let line = &run.line;
    let read = record.as_ref().and_then(|record| record.as_ref().ok());
    html! {
        article.run {
            h1 { (show::outcome(visit, line)) " " a href=(unit_address(&line.serial)) { (show::said(&line.serial)) } }
            (concluded(visit, line.headline.as_deref(), read.map(AsRef::as_ref)))
            @if let Some(Err(why)) = record { p.trouble role="alert" { (show::told(&visit.words.tell(why))) } }
            @for one in &run.waivers { (waiver(visit, one)) }
            (suspects(visit, run, read.map(AsRef::as_ref)))
            (pictures::of_run(visit, line, read.map(AsRef::as_ref), kept))
            (facts(visit, run, read.map(AsRef::as_ref)))
            @if let Some(record) = read {
                (not_exercised(visit, record))
                (steps(visit, record))
                (checks(visit, record))
                (measurements(visit, record))
            }
            (files(visit, run, kept))
            (acts::waive_form(visit, run, refused))
        }
    }
}

/// The result of the run, and what to do.
fn concluded(visit: &Visit, headline: Option<&str>, record: Option<&Record>) -> Markup {
    let finding = record.and_then(|record| record.conclusion.finding.as_ref());
    let recorded = record.and_then(|record| record.conclusion.remedy.as_deref());
    let english = |text: &str| visit.words.english(text.to_owned());
    let (told, asked) = match finding.map(|finding| visit.words.with_remedy(finding, recorded)) {
        Some((told, asked)) => (Some(told), asked),
        None => (headline.map(english), recorded.map(english)),
    };
    let is_unchecked = |record: &Record| {
        record.device == DeviceSeen::NotChecked && record.conclusion.verdict == Verdict::Pass
    };
    html! {
        @if let Some(told) = told {
            p.headline {
                (show::told(&told))
                @if finding.is_some() && record.is_some_and(is_unchecked) {
                    (visit.say("told.also")) (visit.say("run.unchecked"))
                }
            }
        }
        @if let Some(asked) = asked { p.remedy { (show::told(&asked)) } }
    }
}

/// A suspected part in one sentence; `defect` is its code, where the record has it.
pub(super) fn suspect(visit: &Visit, suspect: &history::Suspect, defect: Option<&Said>) -> Markup {
    let share = suspect.share().map(|share| format!("{share:.0}"));
    let fill = |more: &[(&str, &str)]| match &share {
        Some(share) => visit.words.fill("run.suspected", &[more, &[("share", share)]].concat()),
        None => visit.words.fill("run.suspected_alone", more),
    };
    let own = defect.map(|defect| visit.words.tell(defect)).filter(|told| told.foreign.is_none());
    if let Some(told) = own.filter(|_| visit.words.code != "en") {
        let words = fill(&[("what", &told.text)]);
        return html! { p.suspect { (show::said(&words)) } };
    }
    let words = fill(&[]);
    let (before, after) = words.split_once("{what}").unwrap_or_default();
    html! { p.suspect { (before) (show::english(visit, &suspect.named())) (after) } }
}

/// A waiver in one sentence.
pub(super) fn waiver(visit: &Visit, waiver: &Waiver) -> Markup {
    html! {
        p.waiver {
            b { (visit.say("history.waived")) } " " (show::moment(waiver.at_ms)) " · " (show::said(&waiver.operator))
            (visit.say("told.colon")) (show::said(&waiver.reason))
        }
    }
}

/// The suspected parts, each with what a technician should do about it unless the run's own remedy says so.
fn suspects(visit: &Visit, run: &UnitRun, record: Option<&Record>) -> Markup {
    let advice = |place: usize| {
        let record = record?;
        let advice = &record.suspects.get(place)?.technician;
        Some(advice).filter(|&advice| record.conclusion.remedy.as_ref() != Some(advice))
    };
    let defects = record.map(defects).unwrap_or_default();
    html! {
        @for (place, one) in run.suspects.iter().enumerate() {
            @let defect = defects.get(place);
            (suspect(visit, one, defect))
            @if let Some(advice) = advice(place) { p.advice { (show::told(&visit.words.remedy(defect, advice))) } }
        }
    }
}

/// The suspects of the last step that has some, with their codes.
pub(super) fn defects(record: &Record) -> Vec<Said> {
    let of_step = |step: &StepRecord| {
        let all = step.evidence.as_ref()?.get("suspects")?.as_array()?;
        let defect = |suspect: &Value| {
            let part = suspect.get("part").and_then(Value::as_str).unwrap_or_default();
            Said::reported(suspect.get("defect")?, part)
        };
        Some(all.iter().filter_map(defect).collect::<Vec<_>>()).filter(|all| !all.is_empty())
    };
    record.steps.iter().rev().find_map(of_step).unwrap_or_default()
}

fn facts(visit: &Visit, run: &UnitRun, record: Option<&Record>) -> Markup {
    let line = &run.line;
    let board = record.and_then(|record| record.board.as_ref());
    html! {
        dl.facts {
            (show::pair(visit.say("history.began"), show::titled_moment(line.started_ms)))
            @if let Some(seconds) = record.and_then(|record| record.seconds) {
                (show::pair(visit.say("run.took"), html! { (show::number(visit, (seconds * 10.0).round() / 10.0)) " s" }))
            }
            (show::pair(visit.say("history.plan"), html! {
                (show::said(&line.product)) " · " (show::said(&line.plan)) " " (show::said(&line.version))
                @if !run.variant.is_empty() { " · " (show::said(&run.variant)) }
            }))
            (show::pair(visit.say("history.lane"), html! { (show::said(&line.station)) " · " (show::said(&line.lane)) }))
            (show::pair(visit.say("history.operator"), show::said(&line.operator)))
            @if line.is_judgement() {
                (show::pair(visit.say("run.judgement"), line.nth))
            }
            @if line.is_uncounted() { (show::pair(visit.say("run.counts"), visit.say("run.no"))) }
            (show::pair(visit.say("run.board"), html! {
                (show::said(&run.target))
                @if let Some(board) = board { " · " (show::said(&board.name)) " (" (show::said(&board.kind)) ")" }
            }))
            @if let Some(device) = &run.device { (show::pair(visit.say("history.device"), html! { code { (device) } })) }
            @if let Some(build) = &run.build { (show::pair(visit.say("run.build"), html! { code { (build) } })) }
            @if let Some(record) = record {
                (show::pair(visit.say("run.production"), if record.production { visit.say("run.yes") } else { visit.say("run.no") }))
                (show::pair(visit.say("run.program"), show::said(&record.program)))
            }
            (show::pair(visit.say("run.id"), html! { code { (line.id) } }))
            @if let Some(hash) = &line.record_sha256 {
                (show::pair(visit.say("run.record"), html! { code { (hash) } }))
            }
        }
    }
}

/// What a PASS says nothing about.
fn not_exercised(visit: &Visit, record: &Record) -> Markup {
    html! {
        @for (step, parts) in record.not_exercised() {
            h2 { (show::said(&visit.words.fill("run.not_exercised", &[("step", step)]))) }
            ul.untested { @for part in &parts { li { (show::told(&visit.words.tell(part))) } } }
        }
    }
}

fn steps(visit: &Visit, record: &Record) -> Markup {
    html! {
        h2 { (visit.say("run.steps")) }
        div.wide tabindex="0" role="region" aria-label=(visit.say("run.steps")) {
            table.steps { tbody { @for step in &record.steps { (step_row(visit, step, record.took_for(step))) } } }
        }
    }
}

fn step_row(visit: &Visit, step: &StepRecord, took: Option<Duration>) -> Markup {
    let (recorded, english) = (step.remedy.as_deref(), |text: &str| visit.words.english(text.to_owned()));
    let (told, asked) = match &step.finding {
        Some(finding) => visit.words.with_remedy(finding, recorded),
        None => (english(&step.detail), recorded.map(english)),
    };
    html! {
        tr {
            td.number { (step.seq) }
            th scope="row" {
                (show::said(&step.name))
                @if step.attempt > 1 { " " (visit.words.fill("run.attempt", &[("number", &step.attempt.to_string())])) }
            }
            td { (outcome(visit, step.outcome)) }
            td.number { @if let Some(took) = took { (show::number(visit, took.as_secs_f64())) " s" } }
            td {
                (show::told(&told))
                @if let Some(asked) = asked { br; span.soft { (show::told(&asked)) } }
            }
        }
    }
}

/// The outcome of a step, a check or a measurement: a word with a shape.
fn outcome(visit: &Visit, came: StepOutcome) -> Markup {
    let (class, shape, word) = match came {
        StepOutcome::Passed => ("came passed", "✔", visit.say("run.passed")),
        StepOutcome::Failed => ("came failed", "✖", visit.say("run.failed")),
        StepOutcome::Error => ("came error", "⚠", visit.say("run.error")),
        StepOutcome::Skipped => ("came", "–", visit.say("run.skipped")),
    };
    html! { span class=(class) { span aria-hidden="true" { (shape) } " " (word) } }
}

/// What the judge checked in each try of a step.
fn checks(visit: &Visit, record: &Record) -> Markup {
    let text =
        |value: &Value, key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    let all = record
        .steps
        .iter()
        .filter_map(|step| Some((step, step.evidence.as_ref()?.get("checks")?.as_array()?)));
    html! {
        @for (step, checks) in all {
            @let title = visit.words.fill("run.checks", &[("step", &step.name)]);
            h2 { (show::said(&title)) }
            div.wide tabindex="0" role="region" aria-label=(show::said(&title)) { table.checks { tbody { @for check in checks { tr {
                th scope="row" { (show::said(&text(check, "name"))) }
                td {
                    // The report calls outcomes as the record does.
                    @match check.get("outcome").and_then(|came| StepOutcome::deserialize(came).ok()) {
                        Some(came) => (outcome(visit, came)),
                        None => (show::said(&text(check, "outcome"))),
                    }
                }
                td {
                    @match check.get("finding").and_then(|finding| Said::reported(finding, &text(check, "detail"))) {
                        Some(finding) => (show::told(&visit.words.tell(&finding))),
                        None => (show::english(visit, &text(check, "detail"))),
                    }
                }
            } } } } }
        }
    }
}

fn measurements(visit: &Visit, record: &Record) -> Markup {
    let of_steps = record
        .steps
        .iter()
        .flat_map(|step| step.measurements.iter().map(move |one| (step.name.as_str(), one)));
    let all: Vec<_> = of_steps.chain(record.measurements.iter().map(|one| ("", one))).collect();
    html! {
        @if !all.is_empty() {
            h2 { (visit.say("run.measurements")) }
            div.wide tabindex="0" role="region" aria-label=(visit.say("run.measurements")) { table.measurements {
                thead { tr {
                    th { (visit.say("run.measurement")) } th.number { (visit.say("run.value")) } th { (visit.say("run.limit")) }
                    th { (visit.say("run.came")) } th { (visit.say("run.step")) }
                } }
                tbody { @for (step, one) in all { (measured(visit, step, one)) } }
            } }
        }
    }
}

fn measured(visit: &Visit, step: &str, one: &Measured) -> Markup {
    let side =
        |sign: &str, bound: Option<f64>| bound.map(|bound| format!("{sign} {}", show::number(visit, bound)));
    let came = match one.outcome {
        MeasuredOutcome::Passed => StepOutcome::Passed,
        MeasuredOutcome::Failed => StepOutcome::Failed,
        MeasuredOutcome::Unset => StepOutcome::Error,
        MeasuredOutcome::NotJudged => StepOutcome::Skipped,
    };
    let limits = [side("≥", one.low), side("≤", one.high)].into_iter().flatten().collect::<Vec<_>>();
    html! {
        tr {
            th scope="row" { code { (show::said(&one.name)) } }
            td.number {
                @if let Some(value) = one.value { (show::number(visit, value)) " " (show::said(visit.words.unit(&one.unit))) } @else { "–" }
            }
            td { (limits.join(visit.say("told.list"))) @if !limits.is_empty() { " " span.soft { (blamed(visit, one.blames)) } } }
            td { @if limits.is_empty() { span.soft { "–" } } @else { (outcome(visit, came)) } }
            td.soft { (show::said(step)) }
        }
    }
}

/// Whom a limit blames.
fn blamed(visit: &Visit, blame: Blame) -> &'static str {
    match blame {
        Blame::Board => visit.say("blame.board"),
        Blame::Station => visit.say("blame.station"),
        Blame::Nobody => visit.say("blame.nobody"),
    }
}

/// A number of bytes, with the language's decimal point.
fn size(visit: &Visit, bytes: u64) -> String {
    visit.words.figures(&halfrow::words::bytes(bytes))
}

/// Exports and evidence.
fn files(visit: &Visit, run: &UnitRun, kept: &[(Attachment, Whereabouts)]) -> Markup {
    let address = show::run_address(&run.line.id);
    let elsewhere = |place| match place {
        Whereabouts::AtStation => visit.words.fill("run.at_station", &[("station", &run.line.station)]),
        Whereabouts::Removed => visit.say("run.removed").to_owned(),
        Whereabouts::Here | Whereabouts::Lost => visit.say("run.absent").to_owned(),
    };
    html! {
        @if run.line.record_sha256.is_some() {
            h2 { (visit.say("run.exports")) }
            p.exports {
                @for format in Format::value_variants() {
                    a href=(format!("{address}/export/{}", format.name())) download { (format.title()) } " "
                }
            }
        }
        @if !kept.is_empty() {
            h2 { (visit.say("run.evidence")) }
            ul.evidence { @for (one, place) in kept { li {
                @if *place == Whereabouts::Here { a href=(format!("{address}/evidence/{}", one.sha256)) { (show::said(&one.name)) } }
                @else { (show::said(&one.name)) " " span.soft { (show::said(&elsewhere(*place))) } }
                " " span.soft { (size(visit, one.bytes)) " · SHA-256 " code { (one.sha256) } }
            } } }
        }
    }
}
