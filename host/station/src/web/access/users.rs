//! The people who may act: a file of their names, of marks of their badges and of hashes of their passwords.

use std::path::Path;
use std::sync::LazyLock;

use argon2::{Argon2, PasswordHasher as _, PasswordVerifier as _};
use serde::{Deserialize, Serialize};

use super::key::{self, Key};
use crate::floor::Scan;
use crate::secret::{self, SecretError};
use crate::web::routes::Who;
use crate::web::visit::User;

/// The kind of the marks of badges.
const BADGE: &str = "badge";
/// The kind of the marks of sessions' proofs.
const PROOF: &str = "proof";
/// The fewest characters of a password.
const FEWEST: usize = 8;

/// What somebody may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, strum::Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Role {
    /// Tests boards.
    Operator,
    /// Also waives, rebinds, and takes lanes out of service: with a password beside the badge.
    Engineer,
}

/// Somebody, as the file has them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedUser {
    name: String,
    role: Role,
    /// The mark of the badge under the station's key.
    badge: String,
    /// By Argon2id, as a PHC string.
    #[serde(skip_serializing_if = "Option::is_none")]
    password: Option<String>,
}

impl SavedUser {
    /// The mark of the badge, and for an engineer the password, that make them `who`: somebody of the same name with others has
    /// another mark.
    fn proof(&self, key: &Key, who: Who) -> String {
        let password = self.password.as_deref().filter(|_| who == Who::Engineer).unwrap_or_default();
        key.mark(PROOF, &format!("{} {password}", self.badge))
    }
}

/// Somebody who was identified by a badge, or by badge and password.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identified {
    pub(crate) user: User,
    /// The mark of that badge and that password.
    pub(super) proof: String,
}

/// Everybody who may act.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Users {
    #[serde(default)]
    user: Vec<SavedUser>,
}

/// Somebody who cannot be added or removed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum UserError {
    /// The name is taken, or none.
    #[error("`{0}` cannot be the name of somebody else; give another one")]
    Name(String),
    /// The badge is somebody's, a barcode of the station, or empty.
    #[error("this badge is {0}; give another one")]
    Badge(String),
    /// The password is too short.
    #[error("an engineer needs a password of at least {FEWEST} characters; give a longer one")]
    Short,
    /// Nobody has this name.
    #[error("nobody is called `{0}`; `halfrow-station user list` names everybody")]
    Nobody(String),
    /// The password cannot be hashed.
    #[error("the password cannot be kept ({0}); give another one")]
    Hash(String),
    /// The file.
    #[error(transparent)]
    Secret(#[from] SecretError),
}

impl Users {
    /// Everybody in the file `path`.
    ///
    /// # Errors
    /// [`SecretError`]
    pub(crate) fn load(path: &Path) -> Result<Self, SecretError> {
        secret::read(path)
    }

    /// Like [`Self::load`]; nobody, if there is no file.
    ///
    /// # Errors
    /// [`SecretError`]
    pub(crate) fn load_or_none(path: &Path) -> Result<Self, SecretError> {
        secret::read_or_none(path)
    }

    /// Removes somebody from the file `path`.
    ///
    /// # Errors
    /// [`UserError`]
    pub(crate) fn remove_from(path: &Path, name: &str) -> Result<(), UserError> {
        secret::change(path, |users: &mut Self| users.remove(name))
    }

    /// Adds somebody. An engineer has a password.
    ///
    /// # Errors
    /// [`UserError`]
    pub(crate) fn add(
        &mut self,
        key: &Key,
        name: &str,
        role: Role,
        badge: &str,
        password: &str,
    ) -> Result<(), UserError> {
        if name.is_empty()
            || name.chars().any(char::is_control)
            || self.user.iter().any(|user| user.name == name)
        {
            return Err(UserError::Name(name.to_owned()));
        }
        if badge.is_empty() {
            return Err(UserError::Badge("empty".to_owned()));
        }
        if Scan::is_own(badge) {
            return Err(UserError::Badge("a barcode of the station".to_owned()));
        }
        if let Some(other) = self.of_badge(key, badge) {
            return Err(UserError::Badge(format!("that of {}", other.name)));
        }
        let password = match role {
            Role::Operator => None,
            Role::Engineer if password.chars().count() < FEWEST => return Err(UserError::Short),
            Role::Engineer => Some(hashed(password)?),
        };
        self.user.push(SavedUser { name: name.to_owned(), role, badge: key.mark(BADGE, badge), password });
        Ok(())
    }

    /// Removes somebody.
    ///
    /// # Errors
    /// [`UserError::Nobody`]
    fn remove(&mut self, name: &str) -> Result<(), UserError> {
        let before = self.user.len();
        self.user.retain(|user| user.name != name);
        if self.user.len() < before { Ok(()) } else { Err(UserError::Nobody(name.to_owned())) }
    }

    /// Everybody's name and role.
    pub(crate) fn names(&self) -> impl Iterator<Item = (&str, Role)> {
        self.user.iter().map(|user| (user.name.as_str(), user.role))
    }

    fn of_badge(&self, key: &Key, badge: &str) -> Option<&SavedUser> {
        self.user.iter().find(|user| key.is_mark(BADGE, badge, &user.badge))
    }

    /// Who has this badge. With the badge alone everybody is an operator; an engineer also gives the password.
    pub(crate) fn identify(&self, key: &Key, badge: &str, password: &str) -> Option<Identified> {
        let identified = |line: &SavedUser, who| Identified {
            user: User { name: line.name.clone(), who },
            proof: line.proof(key, who),
        };
        let line = self.of_badge(key, badge);
        let known = line.and_then(|line| line.password.as_deref());
        if password.is_empty() {
            return line.map(|line| identified(line, Who::Operator));
        }
        // The time that this takes must not tell somebody who guesses badges whether a badge exists.
        let is_right =
            Argon2::default().verify_password(password.as_bytes(), known.unwrap_or(&NOBODYS)).is_ok();
        line.filter(|_| is_right && known.is_some()).map(|line| identified(line, Who::Engineer))
    }

    /// Whether this person still has the same role, by the same badge and password.
    pub(crate) fn has(&self, key: &Key, Identified { user, proof }: &Identified) -> bool {
        let is = |known: &SavedUser| {
            known.name == user.name
                && (user.who < Who::Engineer || known.role == Role::Engineer)
                && known.proof(key, user.who) == *proof
        };
        self.user.iter().any(is)
    }
}

/// The hash of a password that nobody has.
static NOBODYS: LazyLock<String> = LazyLock::new(|| {
    let drawn = key::drawn().map(|drawn| key::hex(&drawn)).unwrap_or_default();
    hashed(&drawn).unwrap_or_default()
});

fn hashed(password: &str) -> Result<String, UserError> {
    let salt = key::drawn().map_err(SecretError::NoRandomness)?;
    let hash = Argon2::default().hash_password_with_salt(password.as_bytes(), &salt);
    hash.map(|hash| hash.to_string()).map_err(|error| UserError::Hash(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_badge_makes_an_operator_and_the_password_an_engineer() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key::load(&folder.path().join("station.key")).unwrap();
        let mut users = Users::default();
        users.add(&key, "Weber", Role::Operator, "A17", "").unwrap();
        assert!(matches!(users.add(&key, "Braun", Role::Engineer, "B22", "short"), Err(UserError::Short)));
        users.add(&key, "Braun", Role::Engineer, "B22", "correct horse").unwrap();
        assert!(matches!(users.add(&key, "Weber", Role::Operator, "C3", ""), Err(UserError::Name(_))));
        assert!(matches!(users.add(&key, "Vogel", Role::Operator, "A17", ""), Err(UserError::Badge(_))));
        let path = folder.path().join("users.toml");
        secret::write(&path, &users, true).unwrap();
        let users = Users::load(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("A17") && !text.contains("horse") && text.contains("$argon2id$"), "{text}");
        let who = |badge, password| users.identify(&key, badge, password).map(|known| known.user.who);
        assert_eq!(who("A17", ""), Some(Who::Operator));
        assert_eq!(who("A17", "correct horse"), None);
        assert_eq!(who("B22", ""), Some(Who::Operator));
        assert_eq!(who("B22", "correct horse"), Some(Who::Engineer));
        assert_eq!(who("B22", "correct house"), None);
        assert_eq!(who("B2", "correct horse"), None);
        let [braun, operator] =
            ["correct horse", ""].map(|password| users.identify(&key, "B22", password).unwrap());
        assert!(users.has(&key, &braun) && users.has(&key, &operator));
        let mut fewer = users.clone();
        fewer.remove("Braun").unwrap();
        assert!(!fewer.has(&key, &operator));
        fewer.add(&key, "Braun", Role::Engineer, "B22", "correct horse").unwrap();
        assert!(fewer.has(&key, &operator) && !fewer.has(&key, &braun), "another salt, so another password");
    }
}
