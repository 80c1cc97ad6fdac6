//! Small parts of frames, sample by sample.

use halfrow_model::Frame;
use png::EncodingError;

use super::Picture;
use super::scale::{MISSING, colour};
use crate::compare::Difference;
use crate::frames::preview::RgbImage;
use crate::result::Evidence;

/// A part of a frame, around a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) struct Window {
    /// The first difference in it that no earlier window shows.
    pub(in crate::report) around: Difference,
    /// Its first row.
    pub(in crate::report) top: usize,
    /// Its first column.
    pub(in crate::report) left: usize,
    /// Its rows.
    pub(in crate::report) height: usize,
    /// Its columns.
    pub(in crate::report) width: usize,
}

/// A window's pictures in all three frames.
#[derive(Clone, Debug)]
pub(in crate::report) struct Crops {
    /// What went in.
    pub(in crate::report) input: Picture,
    /// What the reference gives.
    pub(in crate::report) expected: Picture,
    /// What the board gave.
    pub(in crate::report) found: Picture,
    /// Where and by how much the last two differ.
    pub(in crate::report) difference: Picture,
    /// The sample values shown as black and as white: the least and the greatest in all three frames, without rows that did not
    /// come back.
    pub(in crate::report) range: (u16, u16),
}

/// Windows around the first differences in reading order, at most `most` of them, and none around a difference that an earlier
/// window shows.
pub(in crate::report) fn windows(evidence: &Evidence, most: usize) -> Vec<Window> {
    let mut windows: Vec<Window> = Vec::new();
    for difference in differences(evidence) {
        if windows.len() == most {
            break;
        }
        if !windows.iter().any(|window| window.shows(&difference)) {
            windows.push(Window::around(difference, &evidence.expected));
        }
    }
    windows
}

/// All differences in reading order.
fn differences(evidence: &Evidence) -> impl Iterator<Item = Difference> {
    evidence.returned().flat_map(|(row, expected, found)| {
        let unequal = move |(column, (&expected, &found))| {
            (expected != found).then_some(Difference { row, column, expected, found })
        };
        expected.iter().zip(found).enumerate().filter_map(unequal)
    })
}

impl Window {
    const WIDTH: usize = 48;
    const HEIGHT: usize = 32;

    /// The window with `around` at its middle, or as near to it as the frame allows.
    fn around(around: Difference, frame: &Frame) -> Self {
        let (width, height) = (Self::WIDTH.min(frame.width()), Self::HEIGHT.min(frame.height()));
        let start =
            |middle: usize, length: usize, all: usize| middle.saturating_sub(length / 2).min(all - length);
        let top = start(around.row, height, frame.height());
        let left = start(around.column, width, frame.width());
        Self { around, top, left, height, width }
    }

    fn shows(&self, difference: &Difference) -> bool {
        (self.top..self.top + self.height).contains(&difference.row)
            && (self.left..self.left + self.width).contains(&difference.column)
    }

    /// The window's samples, row after row; 0 outside the frame.
    fn samples(self, frame: &Frame) -> impl Iterator<Item = u16> {
        (self.top..self.top + self.height).flat_map(move |row| {
            (self.left..self.left + self.width)
                .map(move |column| frame.samples().get(row * frame.width() + column).copied().unwrap_or(0))
        })
    }

    /// The pictures of the window, one pixel a sample, with the same contrast for all three frames.
    ///
    /// # Errors
    /// The PNG encoder's.
    pub(in crate::report) fn crops(self, evidence: &Evidence) -> Result<Crops, EncodingError> {
        let Evidence { input, expected, found, missing, .. } = evidence;
        let is_missing = |place: usize| missing.contains(self.top + place / self.width);
        let found_at = || self.samples(found).enumerate();
        let returned = found_at().filter(|(place, _)| !is_missing(*place));
        let sent = [input, expected].into_iter().flat_map(|frame| self.samples(frame));
        let all = sent.chain(returned.map(|(_, sample)| sample));
        let range = all.fold((u16::MAX, 0), |(least, most), sample| (least.min(sample), most.max(sample)));
        let grey = |sample| [level(sample, range); 3];
        let came = |place: usize, colour| if is_missing(place) { MISSING } else { colour };
        let differs =
            |((place, found), expected): ((usize, u16), u16)| came(place, colour(expected.abs_diff(found)));
        Ok(Crops {
            input: self.picture(self.samples(input).map(grey))?,
            expected: self.picture(self.samples(expected).map(grey))?,
            found: self.picture(found_at().map(|(place, sample)| came(place, grey(sample))))?,
            difference: self.picture(found_at().zip(self.samples(expected)).map(differs))?,
            range,
        })
    }

    fn picture(self, pixels: impl Iterator<Item = [u8; 3]>) -> Result<Picture, EncodingError> {
        Picture::new(&RgbImage { width: self.width, height: self.height, data: pixels.flatten().collect() })
    }
}

/// A sample's grey level, from 0 for the least of the range to 255 for the greatest.
fn level(sample: u16, (least, most): (u16, u16)) -> u8 {
    let span = u32::from(most.saturating_sub(least)).max(1);
    let above = u32::from(sample.saturating_sub(least)).min(span);
    u8::try_from(above * 255 / span).unwrap_or(u8::MAX)
}
