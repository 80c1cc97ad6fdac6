//! Frames that a board gave wrong, kept whole for whoever looks at the run.

use std::fs;
use std::io;
use std::path::Path;

use halfrow::frames::png;
use halfrow::frames::written_aside::{WriteAsideError, write_aside};
use halfrow::model::{BitDepth, Frame, Phase};
use halfrow::result::Evidence;

/// Frames that are kept of a try of a step.
const MOST_FRAMES: usize = 2;
/// Bytes that all frames of a run may have, as PNGs.
const MOST_BYTES: u64 = 32 << 20;
/// How the names of the files end, and no other file of a lane.
const ENDING: &str = ".png";

/// One of the three views of a kept frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum View {
    /// As it went in.
    In,
    /// As it came out; rows that never came back are black.
    Out,
    /// As it should have come out.
    Should,
}

impl View {
    const fn name(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Out => "out",
            Self::Should => "should",
        }
    }
}

/// Which frame a file holds. A PNG says neither depth nor phase, so its name does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KeptFrame {
    /// The step's place in the plan, from 1.
    pub(crate) seq: u32,
    /// Which try, from 1.
    pub(crate) attempt: u32,
    /// Its place in the report's list of frames, from 0.
    pub(crate) index: usize,
    /// The bits of a sample.
    pub(crate) depth: BitDepth,
    /// The arrangement of the colours.
    pub(crate) phase: Phase,
}

impl KeptFrame {
    /// Every view.
    pub(crate) const VIEWS: [View; 3] = [View::In, View::Out, View::Should];

    /// The file's name.
    pub(crate) fn name(&self, view: View) -> String {
        let Self { seq, attempt, index, depth, phase } = self;
        let (bits, view) = (depth.bits(), view.name());
        format!("step-{seq}-try-{attempt}-frame-{index}-{bits}-bit-{phase}-{view}{ENDING}")
    }

    /// The frame and the view that a file of this name holds.
    pub(crate) fn of(name: &str) -> Option<(Self, View)> {
        let words: Vec<_> = name.strip_suffix(ENDING)?.split('-').collect();
        let ["step", seq, "try", attempt, "frame", index, bits, "bit", phase, view] = words[..] else {
            return None;
        };
        let view = Self::VIEWS.into_iter().find(|known| known.name() == view)?;
        let depth = BitDepth::from_bits(bits.parse().ok()?)?;
        let (seq, attempt, index) = (seq.parse().ok()?, attempt.parse().ok()?, index.parse().ok()?);
        Some((Self { seq, attempt, index, depth, phase: phase.parse().ok()? }, view))
    }
}

/// Keeps in `folder` the first frames of `evidence` that differ, each of another name, as a try of a step left them. What cannot be kept is
/// told in the lane's log: no verdict hangs on it.
pub(super) fn keep(folder: &Path, (seq, attempt): (u32, u32), evidence: &[(&str, &Evidence)]) {
    let mut names = Vec::new();
    // The same picture again shows little more.
    let mut is_other = |(name, one): &&(&str, &Evidence)| {
        let is_other = one.found != one.expected && !names.contains(&(*name).to_owned());
        names.extend(is_other.then(|| (*name).to_owned()));
        is_other
    };
    for (_, one) in evidence.iter().filter(|one| is_other(one)).take(MOST_FRAMES) {
        let (depth, phase) = (one.expected.depth(), one.expected.phase());
        let frame = KeptFrame { seq, attempt, index: one.index, depth, phase };
        if let Err(error) = all(folder, &frame, one) {
            tracing::warn!("frame {} is not kept: {:#}", one.index, anyhow::Error::from(error));
        }
    }
}

fn all(folder: &Path, frame: &KeptFrame, evidence: &Evidence) -> Result<(), WriteAsideError> {
    let Evidence { input, found, expected, .. } = evidence;
    let pictures = [input, found, expected].map(encoded);
    let bytes: u64 = pictures.iter().map(|png| png.len() as u64).sum();
    if kept(folder) + bytes > MOST_BYTES {
        tracing::warn!("frame {} is not kept: the run has no room for it", frame.index);
        return Ok(());
    }
    for (view, png) in KeptFrame::VIEWS.into_iter().zip(pictures) {
        write_aside(&folder.join(frame.name(view)), true, |file| file.write_all(&png))?;
    }
    Ok(())
}

/// A frame as a PNG. Memory takes whatever the encoder writes.
fn encoded(frame: &Frame) -> Vec<u8> {
    let mut bytes = Vec::new();
    if let Err(error) = png::encode(frame, &mut bytes) {
        tracing::warn!("a frame cannot be written as PNG: {error}");
    }
    bytes
}

/// The bytes of the frames in `folder`.
fn kept(folder: &Path) -> u64 {
    let sizes = names(folder).unwrap_or_default().into_iter();
    sizes.filter_map(|name| fs::metadata(folder.join(name)).ok()).map(|known| known.len()).sum()
}

/// The names of the files of frames in `folder`, in order.
///
/// # Errors
/// The system's, when the folder cannot be read.
pub(crate) fn names(folder: &Path) -> io::Result<Vec<String>> {
    let entries: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    let names = entries.into_iter().filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<_> = names.filter(|name| KeptFrame::of(name).is_some()).collect();
    names.sort_unstable();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_s_name_says_which_frame_it_holds() {
        let frame = KeptFrame { seq: 2, attempt: 1, index: 7, depth: BitDepth::Ten, phase: Phase::default() };
        for view in KeptFrame::VIEWS {
            assert_eq!(KeptFrame::of(&frame.name(view)), Some((frame.clone(), view)));
        }
        for other in ["events.jsonl", "step-2-try-1-frame-7-9-bit-RGGB-in.png", "../step-2.png", ".png"] {
            assert_eq!(KeptFrame::of(other), None, "{other}");
        }
    }

    /// A frame of which one sample is wrong, `index` in the report.
    fn wrong(index: usize) -> Evidence {
        let expected = Frame::new(8, BitDepth::Twelve, Phase::default(), vec![9; 32]).unwrap();
        let found =
            Frame::new(8, BitDepth::Twelve, Phase::default(), [vec![9; 31], vec![7]].concat()).unwrap();
        Evidence { index, input: expected.clone(), found, expected }
    }

    #[test]
    fn what_differs_is_kept_and_reads_back_and_nothing_else_is() {
        let folder = tempfile::tempdir().unwrap();
        let equal = Evidence { found: wrong(0).expected, ..wrong(0) };
        keep(
            folder.path(),
            (2, 1),
            &[("a", &equal), ("a", &wrong(1)), ("a", &wrong(2)), ("b", &wrong(3)), ("c", &wrong(4))],
        );
        let kept: Vec<_> =
            names(folder.path()).unwrap().iter().map(|name| KeptFrame::of(name).unwrap()).collect();
        let indices: Vec<_> = kept.iter().map(|(frame, _)| frame.index).collect();
        assert_eq!(indices, [1, 1, 1, 3, 3, 3], "two frames of different names, each in three views");
        let (frame, _) = &kept[0];
        let bytes = fs::read(folder.path().join(frame.name(View::Out))).unwrap();
        let how = halfrow::frames::ReadOptions { depth: frame.depth, phase: frame.phase, raw: None };
        assert_eq!(halfrow::frames::decode(&bytes, &how).unwrap(), wrong(1).found);
    }
}
