//! What can go wrong between a file and a frame.

use std::io;
use std::path::PathBuf;

use halfrow_model::{BitDepth, FrameError, Phase};

use super::RawLayout;
use super::format::Format;
use super::photograph::MAX_PIXELS;
use super::size::{MAX_FILE_BYTES, MAX_SIDE};
use halfrow_files::written_aside::WriteAsideError;

/// A file that could not be read as a frame.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refused to open or read the frame's file.
    #[error("cannot read {}; check that it exists and that you may read it", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is longer than any frame.
    #[error("{} is longer than {MAX_FILE_BYTES} bytes; give a file that holds one frame", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
    },
    /// The file holds no frame that can be used; the cause that follows says why and what to do.
    #[error("{} cannot be used as a frame", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What is wrong with its bytes.
        source: DecodeError,
    },
}

/// Bytes that are no frame.
#[derive(Debug, thiserror::Error)]
pub enum DecodeError {
    /// The file is empty.
    #[error("it is empty; copy or export it again")]
    Empty,
    /// The file does not begin like any format that this program knows.
    #[error(
        "it begins like no format known here (PGM P5, PNG, TIFF, DNG, JPEG, WebP, BMP); convert it, or name the layout of \
         samples without a header"
    )]
    UnknownFormat,
    /// The file is of a kind that this program recognises but cannot use.
    #[error("{what} cannot be used; {remedy}")]
    Unsupported {
        /// The kind of file.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// The picture is wider or taller than any sensor.
    #[error("it is {width} x {height}, above {MAX_SIDE} x {MAX_SIDE}; crop it or check its header")]
    TooLarge {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// The photograph has more pixels than this program decodes.
    #[error(
        "it is {width} x {height}, above {most} megapixels; scale it down first",
        most = MAX_PIXELS / 1_000_000
    )]
    TooManyPixels {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// The picture in colour is not of the size that is wanted.
    #[error("it is {width} x {height}, but a frame of {columns} x {rows} is needed; crop and scale it")]
    OtherSize {
        /// Its columns.
        width: usize,
        /// Its rows.
        height: usize,
        /// Columns asked for.
        columns: usize,
        /// Rows asked for.
        rows: usize,
    },
    /// The picture is to be scaled to a size larger than any sensor.
    #[error(
        "it is to be scaled to {columns} x {rows}, above {MAX_SIDE} x {MAX_SIDE}; ask for a smaller size"
    )]
    FittedTooLarge {
        /// Columns asked for.
        columns: usize,
        /// Rows asked for.
        rows: usize,
    },
    /// The file has fewer bytes than its size calls for.
    #[error(
        "it has {found} bytes of samples where its size calls for {expected}; \
         check width, height and layout, or copy the file again"
    )]
    Truncated {
        /// Bytes that the size calls for; at least so many when the file is compressed.
        expected: usize,
        /// Bytes there.
        found: usize,
    },
    /// The file has more bytes after its last sample.
    #[error(
        "it has {extra} more bytes after its last sample{}; {}check width, height and layout, or split a file of \
         several frames",
        padding.map(|bytes| format!(", {bytes} for each row")).unwrap_or_default(),
        if padding.is_some() { "if they pad its rows, cut them off; else " } else { "" }
    )]
    Trailing {
        /// Bytes too many.
        extra: usize,
        /// Bytes too many for each row, if each may have as many and they are fewer than its samples'.
        padding: Option<usize>,
    },
    /// The PGM's header lacks a number.
    #[error("the PGM header has no {wanted} at byte {offset}; it must read `P5 WIDTH HEIGHT MAXVAL`")]
    PgmHeader {
        /// What should be there.
        wanted: &'static str,
        /// Where, in bytes from the start of the file.
        offset: usize,
    },
    /// The PGM's header has a number larger than any frame's.
    #[error(
        "the PGM header's {wanted} at byte {offset} has {digits} digits, more than any frame's; check the header, or \
         write the file again"
    )]
    PgmNumber {
        /// What the number is.
        wanted: &'static str,
        /// Where it begins, in bytes from the start of the file.
        offset: usize,
        /// Its digits.
        digits: usize,
    },
    /// The PGM's header gives a maximum that the format does not allow.
    #[error("the PGM maxval is {0}; it must be 1 to 65535, so write the file again")]
    PgmMaxval(u32),
    /// A sample is larger than the maximum in the PGM's header.
    #[error(
        "the sample at row {row}, column {column} is {value}, above the PGM's own maxval {maxval}; \
         write the file again with the right maxval"
    )]
    AboveMaxval {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The sample.
        value: u16,
        /// The header's maximum.
        maxval: u16,
    },
    /// The photograph cannot be decoded: its file is damaged.
    #[error("the {format} is damaged: {reason}; copy or export it again")]
    Photograph {
        /// JPEG, WebP or BMP.
        format: &'static str,
        /// What the decoder found.
        reason: String,
    },
    /// The PNG cannot be decoded: its file is damaged.
    #[error("the PNG is damaged: {}; copy or export it again", png_damage(.0))]
    Png(png::DecodingError),
    /// The PNG is damaged: a pixel has a colour that its palette does not have.
    #[error(
        "the PNG is damaged: the pixel at row {row}, column {column} has colour {index}, and its palette has {colours} \
         colours, from 0; copy or export it again"
    )]
    PngPalette {
        /// Its row, as stored in the file.
        row: usize,
        /// Its column, as stored in the file.
        column: usize,
        /// The colour's place in the palette.
        index: usize,
        /// Colours of the palette.
        colours: usize,
    },
    /// The TIFF's directory is cut off or malformed.
    #[error("the TIFF's directory is damaged at byte {offset}; copy or export the file again")]
    TiffDirectory {
        /// Where, in bytes from the start of the file.
        offset: usize,
    },
    /// The TIFF cannot be decoded: its file is damaged.
    #[error("the TIFF is damaged: {}; copy or export it again", tiff_damage(.0))]
    Tiff(tiff::TiffError),
    /// The file says that its colours are arranged otherwise than was asked for.
    #[error("it says that its colours lie as {found}, not as {asked}; name the phase {found}")]
    OtherPhase {
        /// The file's.
        found: Phase,
        /// The one asked for.
        asked: Phase,
    },
    /// The file says that its samples have another depth than was asked for.
    #[error(
        "it says that its white is {white}, which is not that of samples of {asked} bits; {}scale it to {asked} bits",
        named.map(|depth| format!("name the bits {}, or ", depth.bits())).unwrap_or_default(),
        asked = asked.bits()
    )]
    OtherDepth {
        /// The file's white.
        white: u32,
        /// The depth that has such a white.
        named: Option<BitDepth>,
        /// The depth asked for.
        asked: BitDepth,
    },
    /// A sample needs more bits than any frame has.
    #[error(
        "the sample at row {row}, column {column} is {value}, above {most}, and no frame has more than {bits} bits; scale it to \
         {bits} bits: divide samples of 16 bits by 16, of 14 bits by 4",
        most = BitDepth::Twelve.max(),
        bits = BitDepth::Twelve.bits()
    )]
    TooDeep {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The sample.
        value: u16,
    },
    /// The rows do not fill whole packing groups.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// The samples are no frame.
    #[error(transparent)]
    Frame(FrameError),
}

/// At the greatest depth there is, a sample that is too bright needs another remedy.
impl From<FrameError> for DecodeError {
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::TooBright { row, column, value, max, .. } if max == BitDepth::Twelve.max() => {
                Self::TooDeep { row, column, value }
            }
            other => Self::Frame(other),
        }
    }
}

/// What a reader says that came to the end of its bytes.
pub(super) const BROKEN_OFF: &str = "it breaks off";

/// What the PNG decoder reported, without the names of its own types.
fn png_damage(error: &png::DecodingError) -> String {
    if let png::DecodingError::IoError(error) = error
        && error.kind() == io::ErrorKind::UnexpectedEof
    {
        return BROKEN_OFF.to_owned();
    }
    let text = error.to_string();
    let text = text.trim_end_matches('.');
    if text.starts_with("Corrupt deflate stream") {
        return "its packed samples are corrupt, or not those of their checksum".to_owned();
    }
    let chunk = text.split_once("ChunkType {").and_then(|(before, rest)| {
        let (inside, after) = rest.split_once('}')?;
        let (_, name) = inside.split_once("type: ")?;
        Some(format!("{before}{}{after}", name.split(',').next().unwrap_or_default().trim()))
    });
    chunk.unwrap_or_else(|| text.to_owned())
}

/// What the TIFF decoder reported.
fn tiff_damage(error: &tiff::TiffError) -> String {
    match error {
        tiff::TiffError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            BROKEN_OFF.to_owned()
        }
        other => other.to_string(),
    }
}

/// The row's width does not fit the raw layout, which packs several samples together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{layout} packs {group} samples together, and {width} columns are no whole number of groups; use u16le"
)]
pub struct PackingError {
    /// The layout.
    pub layout: RawLayout,
    /// Samples that it packs together.
    pub group: usize,
    /// Columns of the frame.
    pub width: usize,
}

/// A frame that could not be written to a file.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file's name does not end in the extension of a known format.
    #[error("the name {} does not tell the format; end it in .pgm, .png, .tif, .tiff, .dng or .raw", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// The picture's name does not end in the extension of a PNG.
    #[error("{} must be a PNG; end its name in .{}", path.display(), Format::Png.extension())]
    NotPng {
        /// The file.
        path: PathBuf,
    },
    /// The frame does not fit the format, or could not be encoded in it.
    #[error("cannot write {} in its format", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Why.
        source: EncodeError,
    },
    /// The file could not be put in its place.
    #[error(transparent)]
    File(#[from] WriteAsideError),
}

/// A frame that could not be turned into bytes.
#[derive(Debug, thiserror::Error)]
pub enum EncodeError {
    /// The output took no more bytes while the frame was being written.
    #[error("the output takes no more bytes; check the space that is left")]
    Io(#[from] io::Error),
    /// The frame could not be encoded as a PNG.
    #[error("the PNG encoder refused the frame; write a PGM instead")]
    Png(#[from] png::EncodingError),
    /// The frame could not be encoded as a TIFF.
    #[error("the TIFF encoder refused the frame; write a PGM instead")]
    Tiff(#[from] tiff::TiffError),
    /// The samples are no frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
}
