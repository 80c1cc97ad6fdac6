//! Machines that read the pages: a file of their names and of marks of their tokens, from which no token can be derived.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::key::{self, Key};
use crate::secret::{self, SecretError};

/// The kind of the marks of tokens.
const TOKEN: &str = "token";

/// What a token is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, strum::Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Scope {
    /// Every page that somebody who is logged in may see, and no act.
    Read,
}

/// A token, as the file has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedToken {
    name: String,
    scope: Scope,
    /// The token's mark under the station's key.
    mark: String,
}

/// Every token.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Tokens {
    #[serde(default)]
    token: Vec<SavedToken>,
}

/// A token that cannot be added or removed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TokenError {
    /// The name is taken, or none.
    #[error("`{0}` cannot be the name of another token; give another one")]
    Name(String),
    /// No token has this name.
    #[error("no token is called `{0}`; `halfrow-station token list` names them all")]
    Nothing(String),
    /// The file.
    #[error(transparent)]
    Secret(#[from] SecretError),
}

impl Tokens {
    /// Every token in the file `path`; none, if there is no file.
    ///
    /// # Errors
    /// [`SecretError`]
    pub(crate) fn load_or_none(path: &Path) -> Result<Self, SecretError> {
        secret::read_or_none(path)
    }

    /// Removes a token from the file `path`.
    ///
    /// # Errors
    /// [`TokenError`]
    pub(crate) fn remove_from(path: &Path, name: &str) -> Result<(), TokenError> {
        secret::change(path, |tokens: &mut Self| tokens.remove(name))
    }

    /// Adds a token of 256 random bits. Returns it in hexadecimal digits; it is written nowhere.
    ///
    /// # Errors
    /// [`TokenError`]
    pub(crate) fn add(&mut self, key: &Key, name: &str, scope: Scope) -> Result<String, TokenError> {
        let is_taken = self.token.iter().any(|token| token.name == name);
        if name.is_empty() || name.chars().any(char::is_control) || is_taken {
            return Err(TokenError::Name(name.to_owned()));
        }
        let token = key::hex(&key::drawn().map_err(SecretError::NoRandomness)?);
        self.token.push(SavedToken { name: name.to_owned(), scope, mark: key.mark(TOKEN, &token) });
        Ok(token)
    }

    /// Removes a token.
    ///
    /// # Errors
    /// [`TokenError::Nothing`]
    fn remove(&mut self, name: &str) -> Result<(), TokenError> {
        let before = self.token.len();
        self.token.retain(|token| token.name != name);
        if self.token.len() < before { Ok(()) } else { Err(TokenError::Nothing(name.to_owned())) }
    }

    /// Every token's name and scope.
    pub(crate) fn names(&self) -> impl Iterator<Item = (&str, Scope)> {
        self.token.iter().map(|token| (token.name.as_str(), token.scope))
    }

    /// The name of this token, if it may read.
    pub(crate) fn reader(&self, key: &Key, token: &str) -> Option<&str> {
        let known = self.token.iter().find(|known| key.is_mark(TOKEN, token, &known.mark))?;
        match known.scope {
            Scope::Read => Some(&known.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_token_is_known_by_its_mark_alone_until_it_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let key = Key::load(&folder.path().join("station.key")).unwrap();
        let path = folder.path().join("tokens.toml");
        let mut tokens = Tokens::load_or_none(&path).unwrap();
        let [mes, other] = ["mes", "other"].map(|name| tokens.add(&key, name, Scope::Read).unwrap());
        assert!(mes.len() == 64 && mes.bytes().all(|digit| digit.is_ascii_hexdigit()), "{mes}");
        assert!(matches!(tokens.add(&key, "mes", Scope::Read), Err(TokenError::Name(_))));
        secret::write(&path, &tokens, true).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(!text.contains(&mes) && !text.contains(&other), "{text}");
        let mut tokens = Tokens::load_or_none(&path).unwrap();
        assert_eq!((tokens.reader(&key, &mes), tokens.reader(&key, &other)), (Some("mes"), Some("other")));
        for wrong in ["", &mes[1..], &"0".repeat(64), &mes.to_uppercase()] {
            assert_eq!(tokens.reader(&key, wrong), None, "{wrong}");
        }
        tokens.remove("mes").unwrap();
        assert_eq!((tokens.reader(&key, &mes), tokens.reader(&key, &other)), (None, Some("other")));
    }
}
