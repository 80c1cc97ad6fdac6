//! Scans, and what is done with lanes.

use std::error::Error;

use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, SET_COOKIE};
use axum::response::{IntoResponse as _, Redirect, Response};
use axum::{Extension, Form};
use futures_util::future;
use serde::{Deserialize, Serialize};

use super::page;
use crate::clock::Moment;
use crate::engine::{Became, Engine};
use crate::floor::{Act, CHOSEN, Scan, ScanError};
use crate::said::{Said, Saying};
use crate::settings::PlanFile;
use crate::web::access::Claimant;
use crate::web::login::{Peer, identified, logged_in};
use crate::web::routes::Who;
use crate::web::state::{App, Lanes};
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// A scan as a page sends it.
#[derive(Debug, Deserialize)]
pub(super) struct Scanned {
    /// The page's own number for it, which the answer repeats.
    #[serde(default)]
    counter: u64,
    text: String,
    /// The lane that was chosen on this page before.
    #[serde(default)]
    lane: String,
    /// Whether that was too long ago.
    #[serde(default)]
    is_over: bool,
    /// The lane that a page without a script had chosen when it was made, and when that was, in milliseconds since the computer
    /// was started, which do not jump when its clock is set.
    #[serde(default)]
    chosen: String,
    #[serde(default)]
    made_ms: i64,
    /// Whether a person may have typed it, without what the scanner adds.
    #[serde(default)]
    typed: bool,
    /// The last beat that the page had heard when the scan was made; empty without a script.
    #[serde(default)]
    beat: String,
}

/// A button as a page sends it.
#[derive(Debug, Deserialize)]
pub(super) struct Pressed {
    /// Like that of a scan.
    #[serde(default)]
    beat: String,
    /// The run that the page showed in the lane, or the serial number where it showed none.
    #[serde(default)]
    of: String,
}

/// The result of a scan, for the page that sent it.
#[derive(Debug, Serialize)]
pub(super) struct ScanReply {
    counter: u64,
    pub(super) is_taken: bool,
    scanned: String,
    lane: Option<String>,
    pub(super) said: String,
    /// The lane that the page's next scan is for.
    pub(super) armed: Option<String>,
    /// Whether somebody else is logged in on the page from now on.
    is_other: bool,
}

pub(super) async fn scan(
    State(app): State<App>,
    Extension(peer): Extension<Peer>,
    visit: Visit,
    Form(scanned): Form<Scanned>,
) -> Result<Response, Trouble> {
    if let Some(response) = badge(&app, &visit, peer, &scanned).await? {
        return Ok(response);
    }
    if !visit.may(Who::Operator) {
        return Err(Trouble::barred(&visit));
    }
    let until = match app.lanes(&visit)?.live.until(&scanned.beat) {
        Ok(until) => until,
        // The page forgets its lane, too: what came too late may be the barcode of another one.
        Err(late) => return Ok(json(&scanned.answer(None, Err(told(&visit, &late)), None))),
    };
    let answer = understood(&app, &visit, &scanned, until).await?;
    if visit.is_script { Ok(json(&answer)) } else { page::answered(app, visit, answer).await }
}

/// The answer to a badge: its owner tests from then on, instead of whoever did. None if it is no badge.
async fn badge(
    app: &App,
    visit: &Visit,
    Peer(peer): Peer,
    scanned: &Scanned,
) -> Result<Option<Response>, Trouble> {
    if !visit.can_log_in {
        return Ok(None);
    }
    let label = app.settings().scanner.label(&scanned.text).unwrap_or(&scanned.text).to_owned();
    // It is no guess, and whoever has guessed too often must still be able to end a run.
    if Scan::is_own(&label) {
        return Ok(None);
    }
    let by = match &visit.user {
        Some(user) => Claimant::Person(user.name.clone()),
        None => Claimant::Stranger(peer),
    };
    let Some(known) = identified(app, visit, by, (label, String::new())).await? else { return Ok(None) };
    let said = visit.words.fill("login.now", &[("name", &known.user.name)]);
    let cookie = logged_in(app, visit, known).await?;
    // A badge is shown to nobody.
    let answer = ScanReply { scanned: String::new(), is_other: true, ..scanned.answer(None, Ok(said), None) };
    let response = if visit.is_script { json(&answer) } else { Redirect::to("/").into_response() };
    Ok(Some(([(SET_COOKIE, cookie)], response).into_response()))
}

/// Carries out the scan, but not after `until`, and answers it.
async fn understood(
    app: &App,
    visit: &Visit,
    scanned: &Scanned,
    until: Option<Moment>,
) -> Result<ScanReply, Trouble> {
    let refused = |error: ScanError| Ok(scanned.answer(None, Err(told(visit, &error)), scanned.armed()));
    let label = app.settings().scanner.label(&scanned.text).map(str::to_owned);
    let Some(label) = label.or_else(|| scanned.typed.then(|| scanned.text.clone())) else {
        return refused(ScanError::Incomplete);
    };
    let armed = match scanned.armed().map(|name| place(app, &name)).transpose() {
        Ok(armed) => armed,
        Err(error) => return refused(error),
    };
    match Scan::read(&label) {
        Ok(Scan::Lane(name)) => match place(app, &name) {
            Ok(_) => {
                let said = told(visit, &Saying::Armed { lane: name.clone() });
                Ok(scanned.answer(Some(name.clone()), Ok(said), Some(name)))
            }
            Err(error) => refused(error),
        },
        Ok(Scan::Act(Act::Out | Act::In)) if !visit.may(Who::Engineer) => {
            let said = visit.for_engineers(visit.say("scan.engineer")).to_owned();
            Ok(scanned.answer(None, Err(said), scanned.armed()))
        }
        _ if armed.is_some() && app.settings().lanes.len() > 1 && scanned.is_over() => {
            let over = ScanError::choice_over(&scanned.lane);
            Ok(scanned.answer(None, Err(told(visit, &over)), None))
        }
        _ => {
            let (lane, name) = armed.unzip();
            let entry = ("scan", name.unwrap_or_default(), kept(app, &label));
            let is_abort = label == Act::Abort.barcode();
            let ask = |engine: &Engine, number| engine.label(number, lane, &label, visit.name(), until);
            let Became { is_taken, lane, said, .. } = asked(app, visit, entry, is_abort, ask).await?;
            let said = visit.words.tell(&said).text;
            let armed = if is_taken { None } else { scanned.armed() };
            Ok(scanned.answer(lane, if is_taken { Ok(said) } else { Err(said) }, armed))
        }
    }
}

impl Scanned {
    fn armed(&self) -> Option<String> {
        (!self.lane.is_empty()).then(|| self.lane.clone())
    }

    /// Whether its lane was chosen too long ago.
    fn is_over(&self) -> bool {
        let is_as_made = self.chosen == self.lane;
        let passed = Moment::now().since_start_ms().saturating_sub(self.made_ms);
        // A page of before the computer's last start may be of any age.
        let is_in_time = (0..=CHOSEN.as_millis() as i64).contains(&passed);
        self.is_over || is_as_made && !is_in_time
    }

    fn answer(&self, lane: Option<String>, said: Result<String, String>, armed: Option<String>) -> ScanReply {
        let is_taken = said.is_ok();
        let said = said.unwrap_or_else(|refused| refused);
        ScanReply {
            counter: self.counter,
            is_taken,
            scanned: self.text.clone(),
            lane,
            said,
            armed,
            is_other: false,
        }
    }
}

/// The index of the lane of this name, and the name.
fn place<'a>(app: &'a App, name: &str) -> Result<(usize, &'a str), ScanError> {
    let lanes = &app.settings().lanes;
    let found = lanes.iter().position(|lane| lane.name == name);
    found
        .and_then(|place| Some((place, lanes.get(place)?.name.as_str())))
        .ok_or_else(|| ScanError::no_lane(name, lanes.iter().map(|lane| lane.name.as_str())))
}

/// What the audit keeps of a scan. What no plan takes may be a badge that is not known here: only its length is kept.
fn kept(app: &App, label: &str) -> String {
    let takes = |file: &PlanFile| file.plan.serial.read(label).is_ok();
    match Scan::read(label) {
        Ok(Scan::Serial(_)) if !app.settings().plans.iter().any(takes) => {
            format!("{} characters", label.chars().count())
        }
        _ => label.to_owned(),
    }
}

/// The result of what `ask` asks of the engine under a number. It is entered in the audit first; an abort only at the same time,
/// so that a full disk does not keep a board from being let go.
async fn asked(
    app: &App,
    visit: &Visit,
    (act, subject, detail): (&'static str, &str, String),
    is_abort: bool,
    ask: impl FnOnce(&Engine, u64),
) -> Result<Became, Trouble> {
    let Lanes { engine, live, .. } = app.lanes(visit)?;
    let entered = app.audit(visit, act, subject, &detail);
    let ask = || {
        let (number, became) = live.ask();
        ask(engine, number);
        became
    };
    let (became, entered) = if is_abort {
        future::join(ask(), entered).await
    } else {
        entered.await?;
        (ask().await, Ok(()))
    };
    if entered.is_err() {
        tracing::error!(
            "the audit does not have that {} asked to abort what was in lane {subject}",
            visit.name()
        );
    }
    became.map_err(|error| Trouble::broken(visit, &error))
}

/// A button of a lane.
type Button = (State<App>, Visit, Path<String>, Form<Pressed>);

pub(super) async fn start(button: Button) -> Result<Response, Trouble> {
    done(button, Act::Start).await
}

pub(super) async fn abort(button: Button) -> Result<Response, Trouble> {
    done(button, Act::Abort).await
}

pub(super) async fn out(button: Button) -> Result<Response, Trouble> {
    done(button, Act::Out).await
}

pub(super) async fn back(button: Button) -> Result<Response, Trouble> {
    done(button, Act::In).await
}

/// Carries out the act on the lane.
async fn done(button: Button, act: Act) -> Result<Response, Trouble> {
    let (State(app), visit, Path(lane), Form(pressed)) = button;
    let (place, name) = place(&app, &lane)
        .map_err(|error| Trouble::telling(&visit, StatusCode::NOT_FOUND, &Said::of(&error)))?;
    let late = |error| Trouble::new(&visit, StatusCode::CONFLICT, told(&visit, &error));
    let until = app.lanes(&visit)?.live.until(&pressed.beat).map_err(late)?;
    let ask = |engine: &Engine, number| engine.act(number, (place, &pressed.of), act, visit.name(), until);
    // Whether something else was in the lane by then is known only afterwards.
    let detail = format!("{} {}", act.barcode(), pressed.of).trim_end().to_owned();
    let became = asked(&app, &visit, ("lane", name, detail), act == Act::Abort, ask).await?;
    match (visit.is_script, became.is_taken) {
        (true, is_taken) => Ok(json(&ScanReply {
            counter: 0,
            is_taken,
            scanned: became.scanned,
            lane: became.lane,
            said: visit.words.tell(&became.said).text,
            armed: None,
            is_other: false,
        })),
        (false, true) => Ok(Redirect::to("/").into_response()),
        (false, false) => Err(Trouble::telling(&visit, StatusCode::CONFLICT, &became.said)),
    }
}

/// The error in the visitor's language.
fn told(visit: &Visit, error: &(dyn Error + 'static)) -> String {
    visit.words.tell(&Said::of(error)).text
}

fn json(answer: &ScanReply) -> Response {
    ([(CONTENT_TYPE, "application/json")], serde_json::to_string(answer).unwrap_or_default()).into_response()
}
