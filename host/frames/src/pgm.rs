//! Binary PGM (P5): samples exactly as they are in the file.
//!
//! The maxval says only how many bytes a sample takes: one up to 255, otherwise two, the high one first. It never scales.

use std::io::{self, Write};

use halfrow_model::{BitDepth, Frame};

use super::raster::{Lines, Raster};
use super::{DecodeError, ReadOptions, size};

/// The first bytes of a PGM.
pub(super) const MAGIC: &[u8] = b"P5";

/// The frame in the bytes of a PGM.
///
/// # Errors
/// [`DecodeError`] when the header is malformed, the raster is not exactly as long as the header says, or a sample is
/// above the header's maxval or above `how.depth`.
pub fn decode(bytes: &[u8], how: &ReadOptions) -> Result<Frame, DecodeError> {
    raster(bytes)?.decode(bytes, how)
}

/// Where the samples are in the PGM that begins with `bytes`.
///
/// # Errors
/// [`DecodeError`] when the header is malformed, or continues beyond `bytes`.
pub(super) fn raster(bytes: &[u8]) -> Result<Raster, DecodeError> {
    let mut header = Header { bytes, offset: MAGIC.len() };
    if !bytes.starts_with(MAGIC) {
        return Err(DecodeError::PgmHeader { wanted: "`P5`", offset: 0 });
    }
    let (width, height) = (header.number("width")?, header.number("height")?);
    let (width, height) = size::checked(width.into(), height.into())?;
    let maxval = header.maxval()?;
    Ok(Raster { width, height, start: header.end()?, lines: Lines::Pgm { maxval } })
}

/// Writes `frame` as a PGM with the maxval 2^B − 1.
///
/// # Errors
/// Those of `out`.
pub fn encode(frame: &Frame, out: &mut impl Write) -> io::Result<()> {
    write_header(out, (frame.width(), frame.height()), frame.depth())?;
    let mut line = Vec::with_capacity(frame.width() * 2);
    for row in frame.rows() {
        line.clear();
        pack(row, frame.depth(), &mut line);
        out.write_all(&line)?;
    }
    Ok(())
}

/// Writes everything before the rows of a PGM of `(width, height)`.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_header(
    out: &mut (impl Write + ?Sized),
    (width, height): (usize, usize),
    depth: BitDepth,
) -> io::Result<()> {
    writeln!(out, "P5\n{width} {height}\n{}", depth.max())
}

/// Appends the bytes of a row.
pub(super) fn pack(row: &[u16], depth: BitDepth, line: &mut Vec<u8>) {
    match depth {
        BitDepth::Eight => line.extend(row.iter().map(|&sample| sample.to_be_bytes()[1])),
        _ => line.extend(row.iter().flat_map(|sample| sample.to_be_bytes())),
    }
}

/// A reader of the header's numbers.
struct Header<'a> {
    bytes: &'a [u8],
    offset: usize,
}

impl<'a> Header<'a> {
    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.offset..).unwrap_or_default()
    }

    /// The next number, after white space or comments, which must not be missing.
    fn number(&mut self, wanted: &'static str) -> Result<u32, DecodeError> {
        let missing = |offset| DecodeError::PgmHeader { wanted, offset };
        let before = self.offset;
        self.skip_blanks();
        let digits = self.rest().iter().take_while(|byte| byte.is_ascii_digit()).count();
        if digits == 0 || self.offset == before {
            return Err(missing(self.offset));
        }
        let value = std::str::from_utf8(&self.rest()[..digits]).ok().and_then(|text| text.parse().ok());
        let value = value.ok_or(DecodeError::PgmNumber { wanted, offset: self.offset, digits })?;
        self.offset += digits;
        Ok(value)
    }

    fn maxval(&mut self) -> Result<u16, DecodeError> {
        let maxval = self.number("maxval")?;
        match u16::try_from(maxval) {
            Ok(fits) if fits > 0 => Ok(fits),
            _ => Err(DecodeError::PgmMaxval(maxval)),
        }
    }

    /// Where the samples begin: after the one white-space byte that ends the header.
    fn end(&self) -> Result<usize, DecodeError> {
        match self.rest() {
            [blank, ..] if blank.is_ascii_whitespace() => Ok(self.offset + 1),
            _ => Err(DecodeError::PgmHeader { wanted: "white space after the maxval", offset: self.offset }),
        }
    }

    fn skip_blanks(&mut self) {
        loop {
            let rest = self.rest();
            let skipped = match rest.first() {
                Some(blank) if blank.is_ascii_whitespace() => 1,
                Some(b'#') => rest.iter().take_while(|&&byte| byte != b'\n').count(),
                _ => return,
            };
            self.offset += skipped;
        }
    }
}
