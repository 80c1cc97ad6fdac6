//! Numbers that a session draws at random.

/// Numbers drawn at random, which tell a session's packets from those of another one. The default draws them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct SessionIds {
    /// The session's nonce.
    pub nonce: u32,
    /// The number of this host.
    pub host: u32,
    /// The sequence number before that of the first packet. A refusal names no nonce, so one that is still under way to an
    /// earlier program must not match by its number. 0 in a recording that does not say, so that its packets begin with 1.
    #[serde(default)]
    pub sequence: u16,
}

impl SessionIds {
    /// Draws them from the operating system's randomness.
    #[must_use]
    pub fn draw() -> Self {
        use std::hash::{BuildHasher, RandomState};
        // A hasher's keys come from the operating system.
        let keys = RandomState::new();
        let (drawn, sequence) = (keys.hash_one(std::process::id()), keys.hash_one("sequence") as u16);
        Self { nonce: drawn as u32, host: (drawn >> 32) as u32, sequence }
    }
}

impl Default for SessionIds {
    fn default() -> Self {
        Self::draw()
    }
}
