//! Keys of engineers (Ed25519, RFC 8032), and what they sign.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use ring::rand::SystemRandom;
use ring::signature::{ED25519, Ed25519KeyPair, KeyPair as _, UnparsedPublicKey};
use serde::{Deserialize, Serialize};

use crate::plan::PlanName;
use crate::secret::{self, SecretError};

/// What public keys begin with.
const KIND: &str = "ed25519:";
/// What stands before everything that is signed, so that no signature of something else is one of a plan.
const PURPOSE: &str = "halfrow plan 1\n";
/// Bytes of a public key.
const BYTES: usize = 32;

/// A key that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SigningError {
    /// The file for the key cannot be made.
    #[error("the key {} cannot be made; name a file that is not there yet", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file cannot be read.
    #[error(transparent)]
    Secret(#[from] SecretError),
    /// The file does not hold a key.
    #[error("{} is no key; make one by: halfrow-station plan key FILE", path.display())]
    NoKey {
        /// The file.
        path: PathBuf,
    },
    /// The system gave no random bytes for a key.
    #[error("the system has no randomness for a key; restart it")]
    NoRandomness,
    /// The text is not a public key.
    #[error("`{text}` is no public key; copy what `halfrow-station plan key` printed")]
    NoPublicKey {
        /// The text.
        text: String,
    },
}

/// An engineer's key.
#[derive(Debug)]
pub struct SigningKey(Ed25519KeyPair);

impl SigningKey {
    /// A new key, in a new file that nobody else may read.
    ///
    /// # Errors
    /// [`SigningError`]
    pub fn draw(path: &Path) -> Result<Self, SigningError> {
        let document =
            Ed25519KeyPair::generate_pkcs8(&SystemRandom::new()).map_err(|_| SigningError::NoRandomness)?;
        secret::create(path, &BASE64_STANDARD.encode(document.as_ref()))
            .map_err(|source| SigningError::File { path: path.to_owned(), source })?;
        Self::load(path)
    }

    /// The key in the file `path`.
    ///
    /// # Errors
    /// [`SigningError`]
    pub fn load(path: &Path) -> Result<Self, SigningError> {
        let no_key = || SigningError::NoKey { path: path.to_owned() };
        let document = BASE64_STANDARD.decode(secret::own(path)?.trim()).map_err(|_| no_key())?;
        Ed25519KeyPair::from_pkcs8(&document).map(Self).map_err(|_| no_key())
    }

    /// What stations know it by.
    #[must_use]
    pub fn public(&self) -> PublicKey {
        PublicKey(BASE64_STANDARD.encode(self.0.public_key().as_ref()))
    }

    /// The signature of a statement's text, in base64.
    #[must_use]
    pub fn sign(&self, text: &str) -> String {
        BASE64_STANDARD.encode(self.0.sign((PURPOSE.to_owned() + text).as_bytes()).as_ref())
    }
}

/// What a station knows an engineer by: `ed25519:` and the key in base64.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PublicKey(String);

impl PublicKey {
    /// The key of this text.
    ///
    /// # Errors
    /// [`SigningError::NoPublicKey`]
    pub fn parse(text: &str) -> Result<Self, SigningError> {
        let key = text.trim().strip_prefix(KIND).unwrap_or_default();
        match BASE64_STANDARD.decode(key) {
            Ok(bytes) if bytes.len() == BYTES => Ok(Self(key.to_owned())),
            _ => Err(SigningError::NoPublicKey { text: text.to_owned() }),
        }
    }

    /// Whether `signature` is its signature of `text`.
    #[must_use]
    fn has_signed(&self, text: &str, signature: &str) -> bool {
        let decoded = BASE64_STANDARD.decode(&self.0).ok().zip(BASE64_STANDARD.decode(signature).ok());
        decoded.is_some_and(|(key, signature)| {
            let signed = PURPOSE.to_owned() + text;
            UnparsedPublicKey::new(&ED25519, key).verify(signed.as_bytes(), &signature).is_ok()
        })
    }
}

impl fmt::Display for PublicKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{KIND}{}", self.0)
    }
}

/// What an engineer signs: from now on this plan holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// The version of the statement's own format.
    pub schema: u32,
    /// The product.
    pub product: String,
    /// The plan's name.
    pub name: String,
    /// The plan's version.
    pub version: String,
    /// The plan's hash.
    pub sha256: String,
    /// The number of this statement among those about plans of this name, counted from 1.
    pub number: i64,
    /// Who says so.
    pub operator: String,
    /// Why.
    pub reason: String,
    /// The key by which it is signed.
    pub key: PublicKey,
}

impl Statement {
    /// The version of the format.
    pub const SCHEMA: u32 = 1;

    /// The text that is signed.
    #[must_use]
    pub fn text(&self) -> String {
        // It has nothing that JSON could not express.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The plan's product and name.
    #[must_use]
    pub fn plan(&self) -> PlanName {
        PlanName { product: self.product.clone(), plan: self.name.clone() }
    }
}

/// The text of a statement with its signature, whoever made them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Signed {
    pub(crate) statement: String,
    pub(crate) signature: String,
}

impl Signed {
    /// What it says, if one of `trusted` has signed it.
    #[must_use]
    pub fn by(&self, trusted: &[PublicKey]) -> Option<Statement> {
        let statement: Statement = serde_json::from_str(&self.statement).ok()?;
        let is_trusted = trusted.contains(&statement.key)
            && statement.schema == Statement::SCHEMA
            && statement.key.has_signed(&self.statement, &self.signature);
        is_trusted.then_some(statement)
    }
}
