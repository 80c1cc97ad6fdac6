//! Who may see and do what.
//!
//! A badge says who somebody is, and makes an operator; badge and password make an engineer. A cookie says who is logged
//! in, and every form carries a mark of that cookie, which no page of another site can know.

mod failures;
mod key;
mod machines;
mod sessions;
mod tokens;
mod users;

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub use tokens::Scope;
pub(crate) use tokens::{TokenError, Tokens};
pub(super) use users::Identified;
pub use users::Role;
pub(crate) use users::{UserError, Users};

use super::visit::User;
use crate::clock;
use crate::secret::{self, SecretError};
use crate::settings::{Address, Settings};
use failures::Failures;
pub(super) use failures::network;
use key::Key;
use machines::Machines;
use parking_lot::Mutex;
use sessions::Sessions;

/// The kinds of the marks of forms and of cookies.
const FORM: &str = "form";
const SESSION: &str = "session";

/// Where the pages are, and who may see and do what there.
#[derive(Debug)]
pub struct Access {
    address: Address,
    people: People,
    key: Key,
    sessions: Mutex<Sessions>,
    /// Who failed to log in, by address.
    failures: Mutex<Failures<IpAddr>>,
    /// Failures of machines, on their own so that one with a wrong token behind a proxy locks no operator out.
    refused: Mutex<Failures<IpAddr>>,
    /// Scans that are no badge, of those who are logged in, by person: other operators may be behind the same proxy, and nobody
    /// begins anew by logging in again.
    scans: Mutex<Failures<String>>,
    machines: Mutex<Machines>,
}

/// Who may act.
#[derive(Debug)]
enum People {
    /// Everybody who gets here.
    Everybody(User),
    /// Who is in `file` and has logged in, until they have been idle for `idle`.
    Listed { file: PathBuf, tokens: Option<PathBuf>, idle: Duration },
}

/// Somebody who identifies themselves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Claimant {
    /// Somebody who is not logged in, by address.
    Stranger(IpAddr),
    /// Somebody who is logged in, by name: what they scan may be another person's badge.
    Person(String),
}

/// A machine that asks with a token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Machine {
    /// It is let in under `name`; `is_noted` says whether the audit has it from this address.
    Known { name: String, is_noted: bool },
    /// It is not let in.
    Unknown,
    /// It is not let in, and must wait this long before it asks again.
    Waits(Duration),
}

/// How many failures within a minute are followed by a wait.
const MOST_FAILURES: usize = 10;
/// How many scans within a minute are followed by a wait: more than anybody makes who does not guess.
const MOST_SCANS: usize = 120;

/// The file of the station's key.
fn key_file(data: &Path) -> PathBuf {
    data.join("station.key")
}

/// The file of who is logged in.
fn sessions_file(data: &Path) -> PathBuf {
    data.join("station.sessions")
}

impl Access {
    /// Access as the settings say. If they name no people, everybody at the computer itself is the user `everybody`.
    ///
    /// # Errors
    /// [`SecretError`] when the station's key or the file of people cannot be used.
    pub fn of(settings: &Settings, everybody: User) -> Result<Self, SecretError> {
        let mut sessions = Sessions::default();
        let people = match &settings.access {
            None => People::Everybody(everybody),
            Some(access) => {
                Users::load(&access.users)?;
                sessions = Sessions::load(&sessions_file(&settings.data))?;
                access.tokens.as_deref().map(Tokens::load_or_none).transpose()?;
                let (file, tokens) = (access.users.clone(), access.tokens.clone());
                People::Listed { file, tokens, idle: access.idle }
            }
        };
        let key = Key::load(&key_file(&settings.data))?;
        let address = settings.address.clone();
        Ok(Self {
            address,
            people,
            key,
            sessions: Mutex::new(sessions),
            failures: Mutex::new(Failures::new(MOST_FAILURES)),
            refused: Mutex::new(Failures::new(MOST_FAILURES)),
            scans: Mutex::new(Failures::new(MOST_SCANS)),
            machines: Mutex::default(),
        })
    }

    /// The same with the port that the system gave for port 0.
    #[must_use]
    pub fn at(self, port: u16) -> Self {
        Self { address: self.address.at(port), ..self }
    }

    /// Where the pages are served.
    #[must_use]
    pub fn listen(&self) -> SocketAddr {
        self.address.listen
    }

    pub(super) fn address(&self) -> &Address {
        &self.address
    }

    /// Whether people log in here at all.
    pub(super) fn has_people(&self) -> bool {
        matches!(self.people, People::Listed { .. })
    }

    /// Whether everybody who gets here may see what is tested.
    pub(super) fn is_open(&self) -> bool {
        self.address.is_private()
    }

    /// Whether nobody who gets here needs to say who they are.
    pub(super) fn asks_nobody(&self) -> bool {
        self.is_open() && !self.has_people()
    }

    /// The user of this cookie, or the one who stands for everybody. It may wait for the disk.
    ///
    /// # Errors
    /// [`SecretError`] when the file of people cannot be read; whoever is logged in stays so.
    pub(super) fn user(&self, session: Option<&str>, is_act: bool) -> Result<Option<User>, SecretError> {
        let (file, idle) = match &self.people {
            People::Everybody(user) => return Ok(Some(user.clone())),
            People::Listed { file, idle, .. } => (file, *idle),
        };
        let Some(mark) = session.map(|session| self.key.mark(SESSION, session)) else { return Ok(None) };
        let known = self.sessions.lock().user(&mark, idle, is_act, clock::now_ms());
        let Some(known) = known else { return Ok(None) };
        // Whoever was removed from the file, or has another badge or password there, is logged out.
        if Users::load(file)?.has(&self.key, &known) {
            return Ok(Some(known.user));
        }
        self.sessions.lock().remove(&mark, clock::now_ms());
        Ok(None)
    }

    /// Who has this badge and this password, if anybody. It takes a while.
    ///
    /// # Errors
    /// Like [`Self::user`].
    pub(super) fn identify(&self, badge: &str, password: &str) -> Result<Option<Identified>, SecretError> {
        let People::Listed { file, .. } = &self.people else { return Ok(None) };
        Ok(Users::load(file)?.identify(&self.key, badge, password))
    }

    /// The machine that asks with this token from `peer`. It may wait for the disk.
    ///
    /// # Errors
    /// [`SecretError`] when the file of tokens cannot be read; that is no failure of the machine.
    pub(super) fn machine(&self, token: &str, peer: IpAddr) -> Result<Machine, SecretError> {
        let tokens = match &self.people {
            People::Listed { tokens: Some(file), .. } => Tokens::load_or_none(file)?,
            _ => Tokens::default(),
        };
        // From here on nothing may wait for the disk, because others wait for the locks.
        let Some(name) = tokens.reader(&self.key, token) else {
            let wait = self.refused.lock().attempt(network(peer), Instant::now());
            return Ok(wait.map_or(Machine::Unknown, Machine::Waits));
        };
        // A right token never waits: nobody guesses 256 bits, and behind a proxy others have the same address.
        let is_noted = self.machines.lock().has(name, peer);
        Ok(Machine::Known { name: name.to_owned(), is_noted })
    }

    /// Notes that the audit has this machine from `peer`.
    pub(super) fn noted(&self, name: String, peer: IpAddr) {
        self.machines.lock().note(name, peer);
    }

    /// Begins a session, of `who` if anybody. Returns the value of its cookie.
    ///
    /// # Errors
    /// When the system has no randomness.
    pub(super) fn begin(&self, who: Option<Identified>) -> Result<String, SecretError> {
        let session = key::hex(&key::drawn().map_err(SecretError::NoRandomness)?);
        if let Some(who) = who {
            self.sessions.lock().add(self.key.mark(SESSION, &session), who, clock::now_ms());
        }
        Ok(session)
    }

    /// Ends the session of this cookie.
    pub(super) fn end(&self, session: &str) {
        self.sessions.lock().remove(&self.key.mark(SESSION, session), clock::now_ms());
    }

    /// The mark of forms that are made for this cookie.
    pub(super) fn form_mark(&self, session: &str) -> String {
        self.key.mark(FORM, session)
    }

    /// Whether a form was made for this cookie.
    pub(super) fn is_form_mark(&self, session: &str, mark: &str) -> bool {
        self.key.is_mark(FORM, session, mark)
    }

    /// Counts an attempt. Returns how long they must wait first, if they must.
    pub(super) fn attempt(&self, by: &Claimant) -> Option<Duration> {
        match by {
            Claimant::Stranger(peer) => self.failures.lock().attempt(network(*peer), Instant::now()),
            Claimant::Person(name) => self.scans.lock().attempt(name.clone(), Instant::now()),
        }
    }

    /// An attempt did not fail.
    pub(super) fn succeeded(&self, by: &Claimant) {
        match by {
            Claimant::Stranger(peer) => self.failures.lock().succeeded(&network(*peer)),
            Claimant::Person(name) => self.scans.lock().succeeded(name),
        }
    }

    /// The name of the cookie. It has the port, because cookies do not tell ports apart.
    pub(super) fn cookie_name(&self) -> String {
        let prefix = if self.address.is_https() { "__Host-" } else { "" };
        format!("{prefix}halfrow-{}", self.address.listen.port())
    }

    /// The cookie of this session, as it is set. A link on a page of another site is followed with it, a form there is sent
    /// without.
    pub(super) fn cookie(&self, session: &str) -> String {
        let secure = if self.address.is_https() { "; Secure" } else { "" };
        format!("{}={session}; Path=/; HttpOnly; SameSite=Lax{secure}", self.cookie_name())
    }
}

/// Adds a token to the file `file`. Returns the token, which is written nowhere.
///
/// # Errors
/// [`TokenError`]
pub(crate) fn add_token(
    settings: &Settings,
    file: &Path,
    name: &str,
    scope: Scope,
) -> Result<String, TokenError> {
    let key = Key::load(&key_file(&settings.data))?;
    secret::change(file, |tokens: &mut Tokens| tokens.add(&key, name, scope))
}

/// Adds somebody to `file`, the people of the settings.
///
/// # Errors
/// [`UserError`]
pub(crate) fn add_user(
    settings: &Settings,
    file: &Path,
    who: (&str, Role),
    badge: &str,
    password: &str,
) -> Result<(), UserError> {
    let key = Key::load(&key_file(&settings.data))?;
    let badge = settings.scanner.label(badge).unwrap_or(badge);
    secret::change(file, |users: &mut Users| users.add(&key, who.0, who.1, badge, password))
}
