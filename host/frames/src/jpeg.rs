//! A first look at a JPEG, which decides whether its decoder may see it: that one fills up what is missing or unknown to it.
//!
//! Markers and their names are those of ITU-T T.81, table B.1.

use super::DecodeError;
use super::error::BROKEN_OFF;
use super::photograph::Format;

/// The first bytes of a JPEG.
pub(super) const MAGIC: &[u8] = b"\xff\xd8\xff";

/// Start of scan.
const SCAN: u8 = 0xda;
/// End of image.
const END: u8 = 0xd9;
/// How a JPEG is to be saved that is of another kind.
const REMEDY: &str = "save it as a baseline or progressive JPEG of 8 bits in RGB";

/// Refuses a JPEG that is not of 8 bits, grey or of three colours, coded by Huffman's baseline, extended or progressive process, or
/// that breaks off. What follows its end is not looked at: cameras put more there.
///
/// # Errors
/// [`DecodeError`] that names what is not taken.
pub(super) fn check(bytes: &[u8]) -> Result<(), DecodeError> {
    let mut segments = Segments { bytes, place: 2 };
    let mut has_frame = false;
    loop {
        let (marker, content) = segments.next().ok_or_else(|| damaged(BROKEN_OFF))?;
        match marker {
            END if has_frame => return Ok(()),
            END => return Err(damaged("it ends before its picture")),
            SCAN => segments.skip_scan(),
            0xc0..=0xcf if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                check_frame(marker, content)?;
                has_frame = true;
            }
            _ => {}
        }
    }
}

/// Refuses what a frame header of the kind `marker` tells that is not taken.
fn check_frame(marker: u8, header: &[u8]) -> Result<(), DecodeError> {
    let &[bits, _, _, _, _, colours, ..] = header else {
        return Err(damaged("its frame header is too short"));
    };
    let what = match (marker, bits, colours) {
        (0xc3 | 0xc7 | 0xcb | 0xcf, ..) => "a lossless JPEG".to_owned(),
        (0xc9.., ..) => "a JPEG that is coded arithmetically".to_owned(),
        (0xc5.., ..) => "a hierarchical JPEG".to_owned(),
        (_, 8, 1 | 3) => return Ok(()),
        (_, 8, 4) => "a CMYK JPEG".to_owned(),
        (_, 8, _) => format!("a JPEG of {colours} colours"),
        _ => format!("a JPEG of {bits} bits a sample"),
    };
    Err(DecodeError::Unsupported { what, remedy: REMEDY })
}

fn damaged(reason: &str) -> DecodeError {
    Format::Jpeg.damaged(reason)
}

/// The segments of a JPEG, each a marker and what its length covers.
struct Segments<'a> {
    bytes: &'a [u8],
    place: usize,
}

impl<'a> Iterator for Segments<'a> {
    type Item = (u8, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        // Fill bytes may stand before a marker, and some cameras leave others behind a segment.
        let marker = loop {
            match self.bytes.get(self.place..)? {
                [0xff, marker @ 1..=0xfe, ..] => break *marker,
                [_, ..] => self.place += 1,
                [] => return None,
            }
        };
        self.place += 2;
        if matches!(marker, 1 | 0xd0..=END) {
            return Some((marker, &[]));
        }
        let &length = self.bytes.get(self.place..)?.first_chunk()?;
        let content = self
            .bytes
            .get(self.place + 2..)?
            .get(..usize::from(u16::from_be_bytes(length)).checked_sub(2)?)?;
        self.place += 2 + content.len();
        Some((marker, content))
    }
}

impl Segments<'_> {
    /// Goes to the next marker behind the coded samples of a scan, among which zeros and restarts follow 0xff.
    fn skip_scan(&mut self) {
        let rest = self.bytes.get(self.place..).unwrap_or_default();
        let end =
            rest.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7 | 0xff));
        self.place += end.unwrap_or(rest.len());
    }
}
