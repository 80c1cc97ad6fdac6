//! Ids that are made before anything else is known.

use rand::TryRng as _;
use rand::rngs::SysRng;
use uuid::{Builder, Uuid};

/// The system gave no random bytes for a new number.
#[derive(Debug, thiserror::Error)]
#[error("the system has no randomness for an id; restart it")]
pub struct NoRandomness(#[source] rand::rngs::SysError);

/// A UUID of version 7 (RFC 9562, section 5.7) of the moment `now_ms`, milliseconds since 1970.
///
/// # Errors
/// [`NoRandomness`]
pub(crate) fn new(now_ms: i64) -> Result<Uuid, NoRandomness> {
    let mut random = [0; 10];
    SysRng.try_fill_bytes(&mut random).map_err(NoRandomness)?;
    Ok(Builder::from_unix_timestamp_millis(now_ms.max(0).unsigned_abs(), &random).into_uuid())
}

/// The seed of the run of this id: 48 of its random bits, which any reader of JSON has room for.
#[must_use]
pub(crate) fn seed(id: Uuid) -> u64 {
    (id.as_u128() & 0xffff_ffff_ffff) as u64
}

/// When a UUID of version 7 was made, in milliseconds since 1970 (RFC 9562, section 5.7); 0 for a text without
/// hexadecimal digits.
#[must_use]
pub(crate) fn made_ms(id: &str) -> i64 {
    let digits: String = id.chars().filter(char::is_ascii_hexdigit).take(12).collect();
    i64::from_str_radix(&digits, 16).unwrap_or_default()
}

/// The prefix that sorts before every version 7 id made at the moment `ms` or later, and after all earlier ones.
#[must_use]
pub(crate) fn first_of(ms: i64) -> String {
    let ms = ms.max(0).unsigned_abs();
    format!("{:08x}-{:04x}", ms >> 16, ms & 0xffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_of_version_7_and_of_its_moment() {
        // The example of RFC 9562, appendix A.6: 22 February 2022, 14:22:22 at UTC-5.
        let id = new(0x017F_22E2_79B0).unwrap();
        assert_eq!((id.get_version_num(), id.get_variant()), (7, uuid::Variant::RFC4122));
        assert!(id.to_string().starts_with("017f22e2-79b0-7"), "{id}");
        assert_eq!(first_of(0x017F_22E2_79B0), "017f22e2-79b0");
        assert!(first_of(0x017F_22E2_79B0) < id.to_string() && first_of(0x017F_22E2_79B1) > id.to_string());
        assert_ne!(new(1).unwrap(), new(1).unwrap());
        assert_eq!(seed("017F22E2-79B0-7CC3-98C4-DC0C0C07398F".parse().unwrap()), 0xDC0C_0C07_398F);
    }
}
