//! A check of a TIFF's directory, which decides whether the decoder may see the file.
//!
//! A header of a few bytes can announce more than fits into memory, and in places the decoder computes with such numbers
//! unchecked. So the tags that set sizes and codings are read here first, and anything but a plain picture is refused.

use halfrow_model::{BitDepth, Phase};

use super::tiff_bytes::{Bytes, SHORT};
use super::{DecodeError, Orientation, ReadOptions, dng, size};

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const PHOTOMETRIC: u16 = 262;
const FILL_ORDER: u16 = 266;
const CHANNELS: u16 = 277;
const PLANAR: u16 = 284;
const TILE_WIDTH: u16 = 322;
const TILE_HEIGHT: u16 = 323;

/// PhotometricInterpretation of camera colours without a filter array.
const LINEAR_RAW: u32 = 34892;

/// How to bring raw samples into a form that is read here.
const UNPACK: &str = "write its raw samples as a 16-bit TIFF, as `dcraw -D -4 -T -t 0` does";

/// What a TIFF or DNG says about the colour filter array of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FilterArray {
    /// The arrangement of the colours.
    phase: Phase,
    /// The sample of full brightness, if the file says it.
    white: Option<u32>,
    /// The offset of the directory entry that declares the filter array.
    entry: usize,
}

impl FilterArray {
    /// Refuses samples of another phase than that of `how`, or whose white calls for another depth: the least that has it. Sensors
    /// often saturate below their converter's range, and some makers say 2^B instead of 2^B − 1.
    ///
    /// # Errors
    /// [`DecodeError::OtherPhase`] or [`DecodeError::OtherDepth`].
    pub(super) fn check(&self, how: &ReadOptions) -> Result<(), DecodeError> {
        if self.phase != how.phase {
            return Err(DecodeError::OtherPhase { found: self.phase, asked: how.phase });
        }
        let Some(white) = self.white else { return Ok(()) };
        let has_white = |&depth: &BitDepth| (1..=u32::from(depth.max()) + 1).contains(&white);
        match BitDepth::ALL.into_iter().find(has_white) {
            Some(depth) if depth == how.depth => Ok(()),
            named => Err(DecodeError::OtherDepth { white, named, asked: how.depth }),
        }
    }

    /// The file `bytes` with its samples declared as grey, since the decoder does not support filter arrays.
    pub(super) fn as_grey(&self, bytes: &[u8]) -> Vec<u8> {
        let little = bytes.starts_with(b"II");
        let short = |value: u16| if little { value.to_le_bytes() } else { value.to_be_bytes() };
        let one = if little { 1_u32.to_le_bytes() } else { 1_u32.to_be_bytes() };
        let mut grey = bytes.to_vec();
        if let Some(entry) = grey.get_mut(self.entry + 2..self.entry + 12) {
            let [kind, value] = [SHORT, 1].map(short);
            entry.copy_from_slice(&[&kind[..], &one, &value, &[0; 2]].concat());
        }
        grey
    }
}

/// What a TIFF or DNG says about its picture, apart from its coding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PictureTags {
    /// Its columns and rows, as stored in the file.
    pub(super) size: (usize, usize),
    /// Whether each pixel has red, green and blue.
    pub(super) is_coloured: bool,
    /// The filter array of raw samples.
    pub(super) array: Option<FilterArray>,
    /// How a viewer must turn the picture.
    pub(super) orientation: Orientation,
}

/// Refuses a TIFF that is not one plain picture: grey from black to white, raw under a colour filter array (DNG), or colour,
/// with or without alpha; with 8 or 16 bits; uncompressed, or packed by LZW, deflate or PackBits. Returns what else the
/// directory says.
///
/// # Errors
/// [`DecodeError`] that names what is not accepted, or the byte where the directory breaks off.
pub(super) fn check(bytes: &[u8]) -> Result<PictureTags, DecodeError> {
    let tags = Tags::read(bytes)?;
    let one = |tag, otherwise| tags.value(tag).unwrap_or(otherwise);
    let (width, height) = size::checked(one(WIDTH, 0).into(), one(HEIGHT, 0).into())?;
    size::checked(one(TILE_WIDTH, 0).into(), one(TILE_HEIGHT, 0).into())?;
    let (colour, channels, bits) = (one(PHOTOMETRIC, 1), one(CHANNELS, 1), one(BITS, 1));
    check_coding(one(COMPRESSION, 1))?;
    check_fill_order(one(FILL_ORDER, 1))?;
    let array = tags.filter_array()?;
    if array.is_some() {
        tags.check_raw(&Bytes::new(bytes), width, height)?;
    }
    if !matches!((colour, channels), (1, 1) | (2, 3 | 4)) && (array.is_none() || channels != 1) {
        let what = format!("a TIFF with colour code {colour} and {channels} channels");
        return Err(DecodeError::Unsupported { what, remedy: "save it as grey (black is zero) or RGB" });
    }
    if !matches!(bits, 8 | 16) {
        let what = format!("a TIFF or DNG of {bits} bits a sample");
        let remedy = if array.is_some() { UNPACK } else { "save it with 8 or 16 bits" };
        return Err(DecodeError::Unsupported { what, remedy });
    }
    if one(PLANAR, 1) != 1 {
        let what = "a TIFF with a plane for each colour".to_owned();
        return Err(DecodeError::Unsupported { what, remedy: "save it with interleaved colours" });
    }
    let samples = width * height * if channels == 1 { 1 } else { 3 };
    size::plausible(bytes.len(), samples * if bits == 8 { 1 } else { 2 })?;
    let (size, is_coloured) = ((width, height), channels > 1);
    Ok(PictureTags { size, is_coloured, array, orientation: Orientation::of_tag(one(Orientation::TAG, 1)) })
}

fn no_bayer_pattern() -> DecodeError {
    let what = "a colour filter array that is no Bayer pattern".to_owned();
    DecodeError::Unsupported { what, remedy: "use a sensor of Bayer's pattern" }
}

/// Refuses samples in a coding that is not read here.
fn check_coding(compression: u32) -> Result<(), DecodeError> {
    let (what, remedy) = match compression {
        1 | 5 | 8 | 32773 | 32946 => return Ok(()),
        6 | 7 => (format!("a TIFF or DNG packed as JPEG (compression {compression})"), UNPACK),
        34892 => ("a DNG packed as lossy JPEG (compression 34892)".to_owned(), UNPACK),
        52546 => ("a DNG packed as JPEG XL (compression 52546)".to_owned(), UNPACK),
        _ => {
            (format!("a TIFF with compression {compression}"), "save it uncompressed, or with LZW or deflate")
        }
    };
    Err(DecodeError::Unsupported { what, remedy })
}

/// Refuses bytes whose bits the decoder would read in the wrong order, without a word.
fn check_fill_order(order: u32) -> Result<(), DecodeError> {
    match order {
        1 => Ok(()),
        _ => {
            let what = format!("a TIFF whose bits are in another order (FillOrder {order})");
            Err(DecodeError::Unsupported { what, remedy: "save it with FillOrder 1" })
        }
    }
}

/// A tag of the first directory, its value as a number (or four bytes as one), and the offset of its entry.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    tag: u16,
    value: u32,
    start: usize,
}

/// The tags of the first directory that matter.
struct Tags(Vec<Entry>);

impl Tags {
    fn read(bytes: &[u8]) -> Result<Self, DecodeError> {
        let file = Bytes::new(bytes);
        if file.short(2)? != 42 {
            return Err(DecodeError::TiffDirectory { offset: 2 });
        }
        let directory = usize::try_from(file.long(4)?).unwrap_or(usize::MAX);
        let entries = usize::from(file.short(directory)?);
        let mut tags = Vec::new();
        for entry in 0..entries {
            let start = directory.saturating_add(2 + 12 * entry);
            file.check_count(start)?;
            let tag = file.short(start)?;
            let value = match tag {
                dng::PATTERN | dng::VERSION => file.four_bytes(start)?,
                // Of a table only its presence matters; the others are read only if the samples are raw.
                dng::LINEARISATION | dng::ACTIVE_AREA | dng::LAYOUT | dng::BLACK_REPEAT => 0,
                tag if tag == dng::REPEAT.0 || Self::BLACKS.contains(&tag) => 0,
                // No size depends on it, so a malformed value does no harm.
                Orientation::TAG => file.value(start).unwrap_or(1),
                tag if Self::wanted(tag) => file.value(start)?,
                _ => continue,
            };
            tags.push(Entry { tag, value, start });
        }
        tags.sort_unstable();
        match tags.windows(2).any(|pair| matches!(pair, [first, second] if first.tag == second.tag)) {
            true => Err(DecodeError::TiffDirectory { offset: directory }),
            false => Ok(Self(tags)),
        }
    }

    fn wanted(tag: u16) -> bool {
        let sizes = [WIDTH, HEIGHT, TILE_WIDTH, TILE_HEIGHT];
        let codings = [BITS, COMPRESSION, PHOTOMETRIC, FILL_ORDER, CHANNELS, PLANAR, dng::WHITE];
        sizes.contains(&tag) || codings.contains(&tag)
    }

    fn entry(&self, tag: u16) -> Option<Entry> {
        self.0.iter().find(|entry| entry.tag == tag).copied()
    }

    fn value(&self, tag: u16) -> Option<u32> {
        self.entry(tag).map(|entry| entry.value)
    }

    /// The tags of the black level.
    const BLACKS: [u16; 3] = [dng::BLACK, dng::BLACK_DELTAS[0], dng::BLACK_DELTAS[1]];

    /// Refuses raw samples of `file`, `width` x `height`, that are not the whole picture, are not in a plain Bayer pattern, or
    /// whose black differs otherwise than from place to place of that pattern.
    fn check_raw(&self, file: &Bytes<'_>, width: usize, height: usize) -> Result<(), DecodeError> {
        let values = |tag| self.entry(tag).map(|entry| file.values(entry.start)).transpose();
        let (repeat, sides) = dng::REPEAT;
        if values(repeat)?.is_some_and(|found| found != sides.map(u32::from)) {
            return Err(no_bayer_pattern());
        }
        if values(dng::LAYOUT)?.is_some_and(|layout| layout != [1]) {
            let what = "a DNG whose CFALayout is staggered".to_owned();
            return Err(DecodeError::Unsupported {
                what,
                remedy: "write its samples in rows and columns first",
            });
        }
        let whole = [0, 0, height, width];
        if let Some(area) = values(dng::ACTIVE_AREA)?
            && !area.iter().map(|&side| usize::try_from(side).ok()).eq(whole.map(Some))
        {
            let what =
                format!("a DNG whose ActiveArea (top, left, bottom, right) is {area:?}, not {whole:?},");
            return Err(DecodeError::Unsupported {
                what,
                remedy: "crop it to that area, and give the phase there",
            });
        }
        self.check_black(file)
    }

    /// Refuses a black level that is not one for all samples, or one for each place of the Bayer pattern. Such a level passes
    /// unchanged: of each output's weights, those of its own colour add up to 1, and those of the row's other one to 0.
    fn check_black(&self, file: &Bytes<'_>) -> Result<(), DecodeError> {
        let values = |tag| self.entry(tag).map(|entry| file.values(entry.start)).transpose();
        let repeats = values(dng::BLACK_REPEAT)?.unwrap_or_default();
        let of_places = repeats.iter().all(|side| matches!(side, 1 | 2));
        let refusals = [
            "a DNG whose BlackLevel repeats over more than two rows or columns",
            "a DNG whose BlackLevelDeltaH is not 0",
            "a DNG whose BlackLevelDeltaV is not 0",
        ];
        for (tag, what) in Self::BLACKS.into_iter().zip(refusals).skip(usize::from(of_places)) {
            if values(tag)?.is_some_and(|black| black.iter().any(|&level| level != 0)) {
                return Err(DecodeError::Unsupported {
                    what: what.to_owned(),
                    remedy: "subtract it from the samples first",
                });
            }
        }
        Ok(())
    }

    /// The filter array of the samples, if they have one.
    fn filter_array(&self) -> Result<Option<FilterArray>, DecodeError> {
        let refused = |what: &str, remedy| Err(DecodeError::Unsupported { what: what.to_owned(), remedy });
        let entry = match self.entry(PHOTOMETRIC) {
            Some(entry) if entry.value == u32::from(dng::FILTER_ARRAY) => entry,
            _ if self.value(dng::VERSION).is_none() => return Ok(None),
            Some(entry) if entry.value == LINEAR_RAW => {
                return refused(
                    "a DNG that is demosaicked already (LinearRaw)",
                    "give the raw file that it was made from",
                );
            }
            _ => {
                let what = "a DNG whose first picture is not its raw one";
                return refused(what, UNPACK);
            }
        };
        if self.value(dng::LINEARISATION).is_some() {
            return refused("a DNG with a table for its samples", "convert it to samples that are linear");
        }
        match dng::phase_of(self.value(dng::PATTERN).unwrap_or(u32::MAX).to_be_bytes()) {
            Some(phase) => Ok(Some(FilterArray { phase, white: self.value(dng::WHITE), entry: entry.start })),
            None => Err(no_bayer_pattern()),
        }
    }
}
