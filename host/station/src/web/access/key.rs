//! The station's key, under which badges are kept and forms are marked.

use std::io;
use std::path::Path;

use hmac::{Hmac, KeyInit as _, Mac as _};
use rand::TryRng as _;
use rand::rngs::SysRng;
use sha2::Sha256;

use crate::secret::{self, SecretError};

/// Bytes of a key, and of what is drawn for a session or a token.
const BYTES: usize = 32;

/// The key.
#[derive(Clone)]
pub(crate) struct Key([u8; BYTES]);

impl std::fmt::Debug for Key {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str("Key")
    }
}

impl Key {
    /// The key in the file `path`; if there is no file, a key is drawn and written to it.
    pub(crate) fn load(path: &Path) -> Result<Self, SecretError> {
        if !path.exists() {
            match Self::draw(path) {
                // Another program was quicker; its key is there as a whole.
                Err(SecretError::File { source, .. }) if source.kind() == io::ErrorKind::AlreadyExists => {}
                drawn => return drawn,
            }
        }
        let text = secret::own(path)?;
        let wrong = || SecretError::Wrong {
            path: path.to_owned(),
            what: "it has no 64 hexadecimal digits".to_owned(),
        };
        Ok(Self(bytes(text.trim()).and_then(|bytes| bytes.try_into().ok()).ok_or_else(wrong)?))
    }

    fn draw(path: &Path) -> Result<Self, SecretError> {
        let key = Self(drawn().map_err(SecretError::NoRandomness)?);
        secret::create(path, &hex(&key.0))
            .map_err(|source| SecretError::File { path: path.to_owned(), source })?;
        Ok(key)
    }

    /// The mark (HMAC-SHA-256, RFC 2104) of `text`, in hexadecimal. `what` tells marks of one kind from those of another.
    pub(crate) fn mark(&self, what: &str, text: &str) -> String {
        hex(&self.hmac(what, text).finalize().into_bytes())
    }

    /// Whether `mark` is that of `text`. The time that this takes does not tell where they differ.
    pub(crate) fn is_mark(&self, what: &str, text: &str, mark: &str) -> bool {
        bytes(mark).is_some_and(|mark| self.hmac(what, text).verify_slice(&mark).is_ok())
    }

    fn hmac(&self, what: &str, text: &str) -> Hmac<Sha256> {
        // A key shorter than the block is padded with zeros (RFC 2104, section 2).
        let block: [u8; 64] = std::array::from_fn(|at| self.0.get(at).copied().unwrap_or(0));
        let mut hmac = Hmac::<Sha256>::new(&block.into());
        hmac.update(what.as_bytes());
        hmac.update(b"\0");
        hmac.update(text.as_bytes());
        hmac
    }
}

/// Random bytes, which nobody can guess.
pub(crate) fn drawn() -> Result<[u8; BYTES], rand::rngs::SysError> {
    let mut drawn = [0; BYTES];
    SysRng.try_fill_bytes(&mut drawn).map(|()| drawn)
}

/// These bytes in hexadecimal digits.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let is_hex = hex.len().is_multiple_of(2) && hex.bytes().all(|digit| digit.is_ascii_hexdigit());
    let pairs = (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(hex.get(at..at + 2)?, 16).ok());
    is_hex.then(|| pairs.collect())?
}

#[cfg(test)]
mod tests {
    use std::fs::{self, Permissions};
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    /// Python: `hmac.new(bytes(range(32)), b"badge\0A17", "sha256").hexdigest()`
    #[test]
    fn a_mark_is_that_of_another_program() {
        let key = Key(std::array::from_fn(|byte| byte as u8));
        let mark = key.mark("badge", "A17");
        assert_eq!(mark, "1101fe80b1d29c5667651d41d57483a21ee0088f22469a3be1cdda4538b453f8");
        assert!(key.is_mark("badge", "A17", &mark));
        assert!(!key.is_mark("csrf", "A17", &mark) && !key.is_mark("badge", "A18", &mark));
        assert!(!key.is_mark("badge", "A17", &mark[2..]) && !key.is_mark("badge", "A17", ""));
    }

    #[test]
    fn a_key_is_drawn_once_and_is_nobody_elses() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.key");
        let drawn = Key::load(&path).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(Key::load(&path).unwrap().0, drawn.0);
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        assert!(matches!(Key::load(&path), Err(SecretError::Open { .. })));
        fs::set_permissions(&path, Permissions::from_mode(0o600)).unwrap();
        fs::write(&path, "12").unwrap();
        assert!(matches!(Key::load(&path), Err(SecretError::Wrong { .. })));
    }
}
