//! What an engineer changes about what was judged: a waiver of a FAIL, another device for a serial number.

use axum::Form;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse as _, Redirect, Response};
use halfrow::Verdict;
use maud::{Markup, html};
use serde::Deserialize;

use super::run_filter::{RunFilter, unit_address};
use super::{run, show, unit};
use crate::history::unit::{Unit, UnitRun};
use crate::said::Said;
use crate::store::{Change, MOST_REASON, NoWaiver, Reason, RebindError, Rebinding, Store};
use crate::web::language::Sentence;
use crate::web::routes::Who;
use crate::web::state::App;
use crate::web::trouble::Trouble;
use crate::web::visit::Visit;

/// The pattern of a device's number, for the browser.
const DEVICE: &str = "[0-9a-f]{16}";

/// Why an act was refused, for the page on which it was asked for, and what was typed there.
#[derive(Debug)]
pub(in crate::web) struct RefusedAct<Typed> {
    pub(in crate::web) status: StatusCode,
    code: String,
    told: Sentence,
    pub(in crate::web) typed: Typed,
}

impl<Typed> RefusedAct<Typed> {
    pub(in crate::web) fn new(visit: &Visit, (status, said): (StatusCode, &Said), typed: Typed) -> Self {
        Self { status, code: said.code.clone(), told: visit.words.tell(said), typed }
    }

    /// The reason with its code.
    pub(in crate::web) fn markup(&self) -> Markup {
        html! { p.refused role="alert" { (show::told(&self.told)) " " code { (self.code) } } }
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct Waive {
    #[serde(default)]
    reason: String,
}

pub(super) async fn waive(
    State(app): State<App>,
    visit: Visit,
    Path(id): Path<String>,
    Form(typed): Form<Waive>,
) -> Result<Response, Trouble> {
    let (run, name) = (id.clone(), visit.name().to_owned());
    let (status, said) = match Reason::of(&typed.reason) {
        Ok(reason) => match app.change(&visit, move |store| store.waive(&run, &name, &reason)).await? {
            Ok(_) => return Ok(Redirect::to(&show::run_address(&id)).into_response()),
            Err(error) => (not_waived(&error), Said::of(&error)),
        },
        Err(error) => (StatusCode::BAD_REQUEST, Said::of(&error)),
    };
    let refused = RefusedAct::new(&visit, (status, &said), typed);
    run::shown(app, visit, id, Some(refused)).await
}

const fn not_waived(error: &NoWaiver) -> StatusCode {
    match error {
        NoWaiver::NoRun { .. } => StatusCode::NOT_FOUND,
        NoWaiver::NoFail { .. } | NoWaiver::Waived { .. } => StatusCode::CONFLICT,
        NoWaiver::NoRandomness(_) | NoWaiver::Store(_) => StatusCode::SERVICE_UNAVAILABLE,
    }
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Rebind {
    serial: String,
    product: String,
    device: String,
    reason: String,
}

pub(super) async fn rebind(
    State(app): State<App>,
    visit: Visit,
    Form(asked): Form<Rebind>,
) -> Result<Response, Trouble> {
    let (typed, name) = (asked.clone(), visit.name().to_owned());
    let serial = typed.serial.clone();
    let (status, said) = match Reason::of(&asked.reason) {
        Ok(reason) => match app.change(&visit, move |store| asked.rebind(store, &name, &reason)).await? {
            Ok(_) => return Ok(Redirect::to(&unit_address(&serial)).into_response()),
            Err(error) => (not_rebound(&error), Said::of(&error)),
        },
        Err(error) => (StatusCode::BAD_REQUEST, Said::of(&error)),
    };
    let refused = RefusedAct::new(&visit, (status, &said), typed);
    unit::shown(app, visit, RunFilter::of_serial(&serial), Some(refused)).await
}

impl Rebind {
    fn rebind(&self, store: &mut Store, operator: &str, reason: &Reason) -> Result<Rebinding, RebindError> {
        let some = |text: &str| Some(text.trim().to_owned()).filter(|text| !text.is_empty());
        let (product, device) = (some(&self.product), some(&self.device));
        let (product, device) = (product.as_deref(), device.as_deref());
        store.rebind(&Change { serial: &self.serial, product, device, operator, reason })
    }
}

const fn not_rebound(error: &RebindError) -> StatusCode {
    match error {
        RebindError::Unknown { .. } => StatusCode::NOT_FOUND,
        RebindError::NoDevice { .. } => StatusCode::BAD_REQUEST,
        RebindError::Several { .. } | RebindError::UnderTest { .. } => StatusCode::CONFLICT,
        RebindError::Store(_) => StatusCode::SERVICE_UNAVAILABLE,
    }
}

/// The form by which an engineer waives the FAIL of a run that has no waiver.
pub(super) fn waive_form(visit: &Visit, run: &UnitRun, refused: Option<&RefusedAct<Waive>>) -> Markup {
    let is_open = run.line.verdict == Some(Verdict::Fail) && run.waivers.is_empty();
    html! {
        @if is_open && visit.may(Who::Engineer) {
            form.change method="post" action=(format!("{}/waive", show::run_address(&run.line.id))) autocomplete="off" {
                h2 { (visit.say("waive.title")) }
                p.soft { (visit.say("waive.about")) }
                (fields(visit, refused.map_or("", |refused| &refused.typed.reason)))
                button { (visit.say("waive.waive")) }
            }
        }
    }
}

/// The form by which an engineer says which device a unit has from then on. After a refusal it is as it was sent: an empty device
/// would ask for something else.
pub(super) fn rebind_form(visit: &Visit, unit: &Unit, refused: Option<&RefusedAct<Rebind>>) -> Markup {
    let typed = refused.map(|refused| &refused.typed).filter(|typed| typed.product == unit.product);
    let (device, reason) = typed.map_or(("", ""), |typed| (&typed.device, &typed.reason));
    html! {
        @if visit.may(Who::Engineer) {
            // The address alone leads back to the unit.
            form.change method="post" action=(RunFilter::of_serial(&unit.serial).address("/unit/rebind", None)) autocomplete="off" {
                h2 { (visit.say("rebind.title")) }
                p.soft { (visit.say("rebind.about")) }
                input type="hidden" name="serial" value=(unit.serial);
                input type="hidden" name="product" value=(unit.product);
                label { span { (visit.say("rebind.device")) }
                    input name="device" value=(device) maxlength="16" pattern=(DEVICE) spellcheck="false" placeholder=(visit.say("rebind.next"));
                }
                (fields(visit, reason))
                button { (visit.say("rebind.rebind")) }
            }
        }
    }
}

/// The mark of the form, and the reason as far as it is typed.
pub(in crate::web) fn fields(visit: &Visit, reason: &str) -> Markup {
    html! {
        input type="hidden" name="csrf" value=(visit.csrf);
        label { span { (visit.say("history.reason")) } input name="reason" value=(reason) required maxlength=(MOST_REASON); }
    }
}
