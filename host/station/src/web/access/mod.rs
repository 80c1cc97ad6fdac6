//! Who may see and do what.
//!
//! A badge says who somebody is, and makes an operator; a password beside it makes an engineer. Who is logged in is known
//! by a cookie, and every form carries a mark of that cookie, which no page of another site can know.

mod address;
mod failures;
mod key;
mod machines;
mod sessions;
mod tokens;
mod users;

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

pub use address::{Address, AddressError};
pub use tokens::{Scope, TokenError, Tokens};
pub(super) use users::Identified;
pub use users::{Role, UserError, Users};

use super::visit::User;
use crate::clock;
use crate::secret::SecretError;
use crate::settings::Settings;
use failures::Failures;
pub(super) use failures::network;
use key::Key;
use machines::Machines;
use sessions::Sessions;

/// What the marks of forms are told from others by, and those of cookies.
const FORM: &str = "form";
const SESSION: &str = "session";

/// Where the pages are, and who may see and do what there.
#[derive(Debug)]
pub struct Access {
    address: Address,
    people: People,
    key: Key,
    sessions: Mutex<Sessions>,
    /// Who failed to log in, by where they are.
    failures: Mutex<Failures<IpAddr>>,
    /// Machines' failures, so that one with a wrong token behind a proxy locks no operator out.
    refused: Mutex<Failures<IpAddr>>,
    /// Scans of those who are logged in that are no badge, by their sessions: other operators may be behind the same proxy.
    scans: Mutex<Failures<String>>,
    machines: Mutex<Machines>,
}

/// Who may act.
#[derive(Debug)]
enum People {
    /// Everybody who gets here.
    Everybody(User),
    /// Who is in the file and has logged in, until they have been idle for so long.
    Listed { file: PathBuf, tokens: Option<PathBuf>, idle: Duration },
}

/// Who says who they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Claimant {
    /// Somebody who is not logged in, by where they are.
    Stranger(IpAddr),
    /// Somebody who is, by their session: what they scan may be the badge of another one.
    Session(String),
}

/// A machine that asks with a token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Machine {
    /// It is let in under this name; the audit has it from there, or not yet.
    Known { name: String, is_noted: bool },
    /// It is not.
    Unknown,
    /// It is not, and has to wait so long until it is told so again.
    Waits(Duration),
}

/// So many failures within a minute are followed by a wait.
const MOST_FAILURES: usize = 10;
/// So many scans within a minute are more than anybody makes who does not guess.
const MOST_SCANS: usize = 120;

/// The station's key, in its folder.
fn key_file(data: &Path) -> PathBuf {
    data.join("station.key")
}

/// Who is logged in, in the station's folder.
fn sessions_file(data: &Path) -> PathBuf {
    data.join("station.sessions")
}

impl Access {
    /// As the settings say. Without people in them everybody at the computer itself is `everybody`.
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

    /// With the port that the system gave for port 0.
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

    /// Who has this cookie, or is everybody. It may wait for the disk.
    ///
    /// # Errors
    /// [`SecretError`] when the file of people cannot tell; whoever is logged in stays so.
    pub(super) fn user(&self, session: Option<&str>, is_act: bool) -> Result<Option<User>, SecretError> {
        let (file, idle) = match &self.people {
            People::Everybody(user) => return Ok(Some(user.clone())),
            People::Listed { file, idle, .. } => (file, *idle),
        };
        let Some(mark) = session.map(|session| self.key.mark(SESSION, session)) else { return Ok(None) };
        let known = self.sessions().user(&mark, idle, is_act, clock::now_ms());
        let Some(known) = known else { return Ok(None) };
        // Whoever was taken from the file, or has another badge or password there, is nobody any more.
        if Users::load(file)?.has(&self.key, &known) {
            return Ok(Some(known.user));
        }
        self.sessions().remove(&mark, clock::now_ms());
        Ok(None)
    }

    /// Who this badge and this password make, and nobody else. It takes a while.
    ///
    /// # Errors
    /// As [`Self::user`].
    pub(super) fn identify(&self, badge: &str, password: &str) -> Result<Option<Identified>, SecretError> {
        let People::Listed { file, .. } = &self.people else { return Ok(None) };
        Ok(Users::load(file)?.identify(&self.key, badge, password))
    }

    /// Which machine has this token, asked from `peer`. It may wait for the disk.
    pub(super) fn machine(&self, token: &str, peer: IpAddr) -> Machine {
        let tokens = match &self.people {
            People::Listed { tokens: Some(file), .. } => Tokens::load_or_none(file),
            _ => Ok(Tokens::default()),
        };
        let tokens = tokens.unwrap_or_else(|error| {
            tracing::error!("{:#}", anyhow::Error::from(error));
            Tokens::default()
        });
        // From here on nothing waits for the disk: others wait for this.
        let Some(name) = tokens.reader(&self.key, token) else {
            let wait = locked(&self.refused).attempt(network(peer), Instant::now());
            return wait.map_or(Machine::Unknown, Machine::Waits);
        };
        // One that is right never waits, for 256 bits are not guessed, and behind a proxy others have the same address.
        let is_noted = locked(&self.machines).has(name, peer);
        Machine::Known { name: name.to_owned(), is_noted }
    }

    /// The audit has that this machine was let in from `peer`.
    pub(super) fn noted(&self, name: String, peer: IpAddr) {
        locked(&self.machines).note(name, peer);
    }

    /// A new session of `who`: the value of its cookie.
    ///
    /// # Errors
    /// When the system has no randomness.
    pub(super) fn begin(&self, who: Option<Identified>) -> Result<String, SecretError> {
        let session = key::hex(&key::drawn().map_err(SecretError::NoRandomness)?);
        if let Some(who) = who {
            self.sessions().add(self.key.mark(SESSION, &session), who, clock::now_ms());
        }
        Ok(session)
    }

    /// Ends the session of this cookie.
    pub(super) fn end(&self, session: &str) {
        self.sessions().remove(&self.key.mark(SESSION, session), clock::now_ms());
    }

    /// What forms carry that were made for this cookie.
    pub(super) fn form_mark(&self, session: &str) -> String {
        self.key.mark(FORM, session)
    }

    /// Whether a form was made for this cookie.
    pub(super) fn is_form_mark(&self, session: &str, mark: &str) -> bool {
        self.key.is_mark(FORM, session, mark)
    }

    /// Somebody tries to say who they are. How long they wait first, if they have to.
    pub(super) fn attempt(&self, by: &Claimant) -> Option<Duration> {
        match by {
            Claimant::Stranger(peer) => locked(&self.failures).attempt(network(*peer), Instant::now()),
            Claimant::Session(session) => locked(&self.scans).attempt(session.clone(), Instant::now()),
        }
    }

    /// An attempt did not fail.
    pub(super) fn succeeded(&self, by: &Claimant) {
        match by {
            Claimant::Stranger(peer) => locked(&self.failures).succeeded(&network(*peer)),
            Claimant::Session(session) => locked(&self.scans).succeeded(session),
        }
    }

    /// The name of the cookie. Cookies do not tell ports apart.
    pub(super) fn cookie_name(&self) -> String {
        let prefix = if self.address.is_https() { "__Host-" } else { "" };
        format!("{prefix}halfrow-{}", self.address.listen.port())
    }

    /// The cookie of this session, as it is set. A link on a page of another site comes with it, and a form does not.
    pub(super) fn cookie(&self, session: &str) -> String {
        let secure = if self.address.is_https() { "; Secure" } else { "" };
        format!("{}={session}; Path=/; HttpOnly; SameSite=Lax{secure}", self.cookie_name())
    }

    fn sessions(&self) -> MutexGuard<'_, Sessions> {
        locked(&self.sessions)
    }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Adds a token to the file `file`; returns it, for it is nowhere written.
///
/// # Errors
/// [`TokenError`]
pub fn add_token(settings: &Settings, file: &Path, name: &str, scope: Scope) -> Result<String, TokenError> {
    let key = Key::load(&key_file(&settings.data))?;
    let mut tokens = Tokens::load_or_none(file)?;
    let token = tokens.add(&key, name, scope)?;
    tokens.save(file)?;
    Ok(token)
}

/// Adds somebody to the file of the settings' people.
///
/// # Errors
/// [`UserError`]
pub fn add_user(
    settings: &Settings,
    file: &Path,
    who: (&str, Role),
    badge: &str,
    password: &str,
) -> Result<(), UserError> {
    let key = Key::load(&key_file(&settings.data))?;
    let mut users = Users::load_or_none(file)?;
    let badge = settings.scanner.label(badge).unwrap_or(badge);
    users.add(&key, who.0, who.1, badge, password)?;
    Ok(users.save(file)?)
}
