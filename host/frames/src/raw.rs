//! Samples without a header: plain bytes and words, and the packings of MIPI CSI-2.
//!
//! RAW10 packs four samples into five bytes: their upper eight bits in order, then their lower two bits in the fifth
//! byte, the first sample's in bits 1:0. RAW12 packs two samples into three bytes: their upper eight bits, then their
//! lower four, the first sample's in bits 3:0.

use std::fmt;
use std::io::{self, Write};
use std::str::FromStr;

use halfrow_model::Frame;

use super::error::PackingError;
use super::raster::{Lines, Raster};
use super::{DecodeError, ReadOptions, size};

/// How samples without a header are laid out in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RawLayout {
    /// One byte per sample.
    U8,
    /// Two bytes per sample, the low one first.
    U16Le,
    /// MIPI RAW10: four samples in five bytes.
    Mipi10,
    /// MIPI RAW12: two samples in three bytes.
    Mipi12,
}

impl RawLayout {
    /// All layouts.
    pub const ALL: [Self; 4] = [Self::U8, Self::U16Le, Self::Mipi10, Self::Mipi12];

    /// The layout in the spelling that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::U8 => "u8",
            Self::U16Le => "u16le",
            Self::Mipi10 => "mipi10",
            Self::Mipi12 => "mipi12",
        }
    }

    /// The most bits that a sample can have.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::U8 => 8,
            Self::U16Le => 16,
            Self::Mipi10 => 10,
            Self::Mipi12 => 12,
        }
    }

    /// Samples of one packing group, and the bytes that it takes.
    fn group(self) -> (usize, usize) {
        match self {
            Self::U8 => (1, 1),
            Self::U16Le => (1, 2),
            Self::Mipi10 => (4, 5),
            Self::Mipi12 => (2, 3),
        }
    }

    /// Bytes of a row of `width` samples.
    pub(super) fn line_bytes(self, width: usize) -> usize {
        let (group_samples, group_bytes) = self.group();
        width / group_samples * group_bytes
    }

    /// Unpacks the bytes of a row.
    pub(super) fn unpack(self, line: &[u8], row: &mut [u16]) {
        let (group_samples, group_bytes) = self.group();
        match self {
            Self::U8 => row.iter_mut().zip(line).for_each(|(sample, &byte)| *sample = byte.into()),
            Self::U16Le => {
                let pairs = line.as_chunks().0;
                row.iter_mut().zip(pairs).for_each(|(sample, &pair)| *sample = u16::from_le_bytes(pair));
            }
            Self::Mipi10 | Self::Mipi12 => {
                let groups = row.chunks_exact_mut(group_samples).zip(line.chunks_exact(group_bytes));
                groups.for_each(|(group, bytes)| self.unpack_group(bytes, group));
            }
        }
    }

    fn unpack_group(self, bytes: &[u8], group: &mut [u16]) {
        let low_bits = self.bits() - 8;
        let Some((low, high)) = bytes.split_last() else { return };
        for ((sample, &byte), place) in group.iter_mut().zip(high).zip(0..) {
            *sample =
                u16::from(byte) << low_bits | u16::from(low >> (place * low_bits)) & ((1 << low_bits) - 1);
        }
    }

    fn check_width(self, width: usize) -> Result<(), PackingError> {
        let (group, _) = self.group();
        if width.is_multiple_of(group) {
            return Ok(());
        }
        Err(PackingError { layout: self, group, width })
    }
}

impl fmt::Display for RawLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The word is not the name of a layout of raw samples.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no layout of raw samples; use u8, u16le, mipi10 or mipi12")]
pub struct UnknownLayout(String);

impl FromStr for RawLayout {
    type Err = UnknownLayout;

    fn from_str(text: &str) -> Result<Self, UnknownLayout> {
        let named = |layout: &Self| layout.name().eq_ignore_ascii_case(text);
        Self::ALL.into_iter().find(named).ok_or_else(|| UnknownLayout(text.to_owned()))
    }
}

/// What a headerless file does not say about itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawGeometry {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// How the samples are laid out in bytes.
    pub layout: RawLayout,
}

/// The frame in headerless bytes. Rows follow one another without padding.
///
/// # Errors
/// [`DecodeError`] when the length is not exactly that of the geometry, when a row is not a whole number of packing groups,
/// or when a sample exceeds `how.depth`.
pub fn decode(bytes: &[u8], geometry: RawGeometry, how: &ReadOptions) -> Result<Frame, DecodeError> {
    raster(geometry)?.decode(bytes, how)
}

/// Where the rows of a headerless file are.
///
/// # Errors
/// [`DecodeError`] when a side is too long, or a row is not a whole number of packing groups.
pub(super) fn raster(geometry: RawGeometry) -> Result<Raster, DecodeError> {
    let RawGeometry { width, height, layout } = geometry;
    let (width, height) = size::checked(width as u64, height as u64)?;
    layout.check_width(width)?;
    Ok(Raster { width, height, start: 0, lines: Lines::Raw(layout) })
}

/// Appends the bytes of a row in [`RawLayout::U16Le`].
pub(super) fn pack(row: &[u16], line: &mut Vec<u8>) {
    line.extend(row.iter().flat_map(|sample| sample.to_le_bytes()));
}

/// Writes the samples of `frame` in [`RawLayout::U16Le`], without a header.
///
/// # Errors
/// Those of `out`.
pub fn encode(frame: &Frame, out: &mut impl Write) -> io::Result<()> {
    let mut line = Vec::with_capacity(frame.width() * 2);
    for row in frame.rows() {
        line.clear();
        pack(row, &mut line);
        out.write_all(&line)?;
    }
    Ok(())
}
