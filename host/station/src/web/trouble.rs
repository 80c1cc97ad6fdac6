//! Why there is no page, or why an act was not done.

use std::fmt::Display;
use std::time::Duration;

use axum::http::header::{CONTENT_TYPE, WWW_AUTHENTICATE};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use maud::{Markup, html};
use serde_json::json;

use super::history::show;
use super::language::Sentence;
use super::layout::{Here, Page};
use super::login;
use super::routes::Who;
use super::visit::Visit;
use crate::said::Said;
use crate::secret::SecretError;
use crate::store::StoreError;

/// An answer that says what is wrong, and what to do.
#[derive(Debug)]
pub(super) struct Trouble {
    status: StatusCode,
    visit: Box<Visit>,
    told: Sentence,
    /// The code by which the handbook lists it, if it has one.
    code: Option<String>,
    /// Whether the page that asked has to be loaded anew first.
    is_stale: bool,
    /// Where a login leads, if the answer is the form that takes a badge.
    login: Option<String>,
}

impl Trouble {
    /// What is wrong and what to do, with its status.
    pub(super) fn new(visit: &Visit, status: StatusCode, said: impl Into<String>) -> Self {
        Self::saying(visit, status, Sentence { text: said.into(), foreign: None })
    }

    /// The form is not for whoever sends it.
    pub(super) fn stale(visit: &Visit) -> Self {
        Self { is_stale: true, ..Self::new(visit, StatusCode::FORBIDDEN, visit.say("trouble.mark")) }
    }

    /// What has a code, in the visitor's language.
    pub(super) fn telling(visit: &Visit, status: StatusCode, said: &Said) -> Self {
        let code = Some(said.code.clone()).filter(|code| !code.is_empty());
        Self { code, ..Self::saying(visit, status, visit.words.tell(said)) }
    }

    fn saying(visit: &Visit, status: StatusCode, told: Sentence) -> Self {
        Self { status, visit: Box::new(visit.clone()), told, code: None, is_stale: false, login: None }
    }

    /// The same on the page that takes a badge, from which a login leads to `page`: a scanner has no way back.
    pub(super) fn at_login(self, page: String) -> Self {
        Self { login: Some(page), ..self }
    }

    /// What is wrong, for a page that has the rest of what was asked for.
    pub(super) fn told(&self) -> Markup {
        show::told(&self.told)
    }

    /// The visitor may not do this.
    pub(super) fn barred(visit: &Visit) -> Self {
        match (&visit.user, &visit.untold) {
            (None, Some(why)) => Self::telling(visit, StatusCode::SERVICE_UNAVAILABLE, why),
            (None, None) => Self::new(visit, StatusCode::UNAUTHORIZED, visit.say("trouble.login")),
            (Some(_), _) if visit.may(Who::Operator) => {
                Self::new(visit, StatusCode::FORBIDDEN, visit.for_engineers(visit.say("trouble.engineer")))
            }
            (Some(_), _) => Self::new(visit, StatusCode::FORBIDDEN, visit.say("trouble.forbidden")),
        }
    }

    /// The visitor has failed too often, and must wait this long.
    pub(super) fn waits(visit: &Visit, wait: Duration) -> Self {
        let seconds = (wait.as_secs() + 1).to_string();
        let said = visit.words.fill("login.wait", &[("seconds", &seconds)]);
        Self::new(visit, StatusCode::TOO_MANY_REQUESTS, said)
    }

    /// Nothing has this address.
    pub(super) fn missing(visit: &Visit) -> Self {
        Self::new(visit, StatusCode::NOT_FOUND, visit.say("trouble.missing"))
    }

    /// The request has a value that is not valid.
    pub(super) fn wrong(visit: &Visit, said: impl Into<String>) -> Self {
        Self::new(visit, StatusCode::BAD_REQUEST, said)
    }

    /// The store refuses. The reason is logged as well, for the engineer.
    pub(super) fn store(visit: &Visit, error: &StoreError) -> Self {
        let said = Said::of(error);
        tracing::error!("{}", said.with_codes());
        Self::telling(visit, StatusCode::SERVICE_UNAVAILABLE, &said)
    }

    /// It cannot be found out who somebody is.
    pub(super) fn secret(visit: &Visit, error: &SecretError) -> Self {
        let said = Said::of(error);
        tracing::error!("{}", said.with_codes());
        Self::telling(visit, StatusCode::SERVICE_UNAVAILABLE, &said)
    }

    /// A part of the program itself failed.
    pub(super) fn broken(visit: &Visit, error: &dyn Display) -> Self {
        tracing::error!("a page was not made: {error}");
        Self::new(visit, StatusCode::INTERNAL_SERVER_ERROR, visit.say("trouble.broken"))
    }
}

impl IntoResponse for Trouble {
    fn into_response(self) -> Response {
        let is_stranger = self.status == StatusCode::UNAUTHORIZED;
        let mut response = self.page();
        if is_stranger {
            // RFC 9110, section 15.5.2, demands a challenge. Browsers ask nobody anything for this one.
            response.headers_mut().insert(WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
        }
        response
    }
}

impl Trouble {
    fn page(self) -> Response {
        let Self { status, visit, told, code, is_stale, login } = self;
        if visit.is_script {
            let text = json!({ "is_taken": false, "said": told.text, "is_stale": is_stale }).to_string();
            return (status, [(CONTENT_TYPE, "application/json")], text).into_response();
        }
        if let Some(page) = login {
            return login::asked(&visit, Some(&told), &page).with_status(&visit, status);
        }
        let content = html! {
            section.trouble {
                h1 { (status.as_u16()) }
                p role="alert" { (show::told(&told)) }
                @if let Some(code) = code { p { small { (code) } } }
            }
        };
        let page = Page { here: Here::Elsewhere, title: visit.say("trouble.title"), head: html! {}, content };
        page.with_status(&visit, status)
    }
}
