//! The hash that identifies files and frames.

use sha2::{Digest, Sha256};

/// SHA-256 of all `parts`, one after the other, in hexadecimal.
pub fn sha256<P: AsRef<[u8]>>(parts: impl IntoIterator<Item = P>) -> String {
    let mut hash = Sha256::new();
    parts.into_iter().for_each(|part| hash.update(part));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The samples as bytes, little endian, as frames are hashed.
pub(crate) fn little_endian(samples: &[u16]) -> Vec<u8> {
    samples.iter().map(|sample| sample.to_le_bytes()).collect::<Vec<_>>().into_flattened()
}
