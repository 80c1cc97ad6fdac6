//! Limits that are checked before anything is allocated.

use super::DecodeError;

/// The longest side of a picture that is read at all. The geometry checks the datapath's own, smaller limits.
pub const MAX_SIDE: usize = 8192;

/// The longest file that is read at all, in bytes: [`MAX_SIDE`] squared, four channels of 16 bits, and room for a header.
pub(crate) const MAX_FILE_BYTES: usize = MAX_SIDE * MAX_SIDE * 8 + (1 << 20);

/// The most bytes that one compressed byte can expand to: about 1,030 in deflate, 1,400 in LZW, 64 in PackBits.
const MAX_EXPANSION: usize = 2048;

/// The width and height as `usize`.
///
/// # Errors
/// [`DecodeError::TooLarge`] when a side is above [`MAX_SIDE`].
pub(super) fn checked(width: u64, height: u64) -> Result<(usize, usize), DecodeError> {
    match (usize::try_from(width), usize::try_from(height)) {
        (Ok(columns), Ok(rows)) if columns <= MAX_SIDE && rows <= MAX_SIDE => Ok((columns, rows)),
        _ => Err(DecodeError::TooLarge { width, height }),
    }
}

/// Checks that there are exactly `expected` bytes of samples.
///
/// # Errors
/// [`DecodeError::Truncated`] when there are fewer, [`DecodeError::Trailing`] when there are more.
pub(super) fn exact(found: usize, expected: usize) -> Result<(), DecodeError> {
    match found.checked_sub(expected) {
        None => Err(DecodeError::Truncated { expected, found }),
        Some(0) => Ok(()),
        Some(extra) => Err(DecodeError::Trailing { extra, padding: None }),
    }
}

/// Checks that `compressed` bytes can expand to `expanded` bytes at all.
///
/// # Errors
/// [`DecodeError::Truncated`] when no lossless coding read here packs that tightly.
pub(super) fn plausible(compressed: usize, expanded: usize) -> Result<(), DecodeError> {
    let least = expanded.div_ceil(MAX_EXPANSION);
    if compressed < least {
        return Err(DecodeError::Truncated { expected: least, found: compressed });
    }
    Ok(())
}
