//! Who asks for a page, and in which language.

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};

use super::language::{self, Words};
use super::routes::Who;
use super::state::App;
use super::trouble::Trouble;
use crate::said::Said;

/// Somebody who is known by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct User {
    /// The name, which is in records and in the audit.
    pub name: String,
    /// What they may do: operator or engineer; a machine with a token is a reader.
    pub who: Who,
}

/// What the guard found out about a request.
#[derive(Clone, Debug)]
pub(super) struct Visit {
    /// The language's words.
    pub(super) words: &'static Words,
    /// Who asks, if it is somebody known.
    pub(super) user: Option<User>,
    /// Why it could not be found out who asks.
    pub(super) untold: Option<Said>,
    /// The value of the cookie that the visitor has, or is given.
    pub(super) session: String,
    /// Whether everybody who gets here may see what is tested.
    pub(super) is_open: bool,
    /// Whether this cookie is new.
    pub(super) is_new: bool,
    /// Whether people log in at this station.
    pub(super) can_log_in: bool,
    /// The mark that every form sends back in its field `csrf`.
    pub(super) csrf: String,
    /// The station's name.
    pub(super) station: String,
    /// Whether it is a plant, whose pages only look.
    pub(super) is_plant: bool,
    /// Its plans by product, name and version.
    pub(super) plans: String,
    /// Whether the page's script asks, which takes answers as JSON.
    pub(super) is_script: bool,
}

impl Visit {
    /// The words of this key in the visitor's language.
    pub(super) fn say(&self, key: &'static str) -> &'static str {
        self.words.say(key)
    }

    /// `words` that ask for an engineer, or those for a station where nobody can be one.
    pub(super) fn for_engineers(&self, words: &'static str) -> &'static str {
        if self.can_log_in { words } else { self.say("trouble.unlisted") }
    }

    /// The visitor's name, for records and the audit.
    pub(super) fn name(&self) -> &str {
        self.user.as_ref().map_or("", |user| user.name.as_str())
    }

    /// Whether the visitor may do what `who` may.
    pub(super) fn may(&self, who: Who) -> bool {
        let least = if self.is_open { Who::Reader } else { Who::Anyone };
        self.user.as_ref().map_or(least, |user| user.who.max(least)) >= who
    }
}

impl FromRequestParts<App> for Visit {
    type Rejection = Trouble;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Trouble> {
        // The guard of the route left it there.
        Ok(parts.extensions.get::<Self>().cloned().unwrap_or_else(|| app.stranger(&parts.headers)))
    }
}

impl App {
    /// A visit of somebody unknown.
    pub(super) fn stranger(&self, headers: &HeaderMap) -> Visit {
        let words = language::of(cookie(headers, language::COOKIE), headers.get(header::ACCEPT_LANGUAGE));
        let is_script = headers.get(header::ACCEPT).is_some_and(|value| value == "application/json");
        let (station, plans) = (self.station().to_owned(), self.plans().to_owned());
        let (session, csrf) = (String::new(), String::new());
        Visit {
            words,
            user: None,
            untold: None,
            session,
            is_open: self.access().is_open(),
            is_new: true,
            can_log_in: false,
            csrf,
            station,
            is_plant: self.is_plant(),
            plans,
            is_script,
        }
    }
}

/// The cookie of this name.
pub(super) fn cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let all = headers.get_all(header::COOKIE).into_iter().filter_map(|value| value.to_str().ok());
    let pairs = all.flat_map(|value| value.split(';')).filter_map(|pair| pair.trim().split_once('='));
    pairs.into_iter().find(|(known, _)| *known == name).map(|(_, value)| value)
}
