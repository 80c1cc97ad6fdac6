//! Wrong frames from a board, kept whole for whoever looks into the run.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;

use halfrow::files::written_aside::{WriteAsideError, write_aside};
use halfrow::frames::png;
use halfrow::model::{BitDepth, Frame, Phase};
use halfrow::result::Evidence;
use strum::{Display, EnumString};

/// The most frames that are kept of a try of a step.
const MOST_FRAMES: usize = 2;
/// The most bytes that all frames of a run may take, as PNGs.
const MOST_BYTES: u64 = 32 << 20;
/// The ending of the files' names, which no other file of a lane has.
const ENDING: &str = ".png";
/// The file that names what is not kept, and why.
pub(crate) const NOT_KEPT: &str = "not-kept.txt";

/// Why a picture or a report is not kept.
#[derive(Debug, thiserror::Error)]
pub(super) enum NotKept {
    #[error("it cannot be written as PNG; report this with the plan and the board")]
    Encode(#[source] io::Error),
    #[error("the frames of the run take more than {MOST_BYTES} bytes; let its steps have smaller frames")]
    NoRoom,
    #[error("the judge had no room for it; let its step have smaller frames")]
    LeftOut,
    #[error("it is too long; let its step have fewer or smaller frames")]
    LongReport,
    #[error(transparent)]
    Write(#[from] WriteAsideError),
}

/// One of the three views of a kept frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, EnumString)]
#[strum(serialize_all = "lowercase")]
pub(crate) enum View {
    /// As it went in.
    In,
    /// As it came out; rows that never came back are black.
    Out,
    /// As it should have come out.
    Should,
}

/// Which frame a file holds. A PNG states neither depth nor phase, so its name does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KeptFrame {
    /// The step's place in the plan, from 1.
    pub(crate) seq: u32,
    /// Which try, from 1.
    pub(crate) attempt: u32,
    /// Its index in the report's list of frames, from 0.
    pub(crate) index: usize,
    /// The bits of a sample.
    pub(crate) depth: BitDepth,
    /// The arrangement of the colours.
    pub(crate) phase: Phase,
}

impl KeptFrame {
    /// All views.
    pub(crate) const VIEWS: [View; 3] = [View::In, View::Out, View::Should];

    /// The file's name.
    pub(crate) fn name(&self, view: View) -> String {
        let Self { seq, attempt, index, depth, phase } = self;
        let bits = depth.bits();
        format!("step-{seq}-try-{attempt}-frame-{index}-{bits}-bit-{phase}-{view}{ENDING}")
    }

    /// The frame and the view that a file of this name holds.
    pub(crate) fn of(name: &str) -> Option<(Self, View)> {
        let words: Vec<_> = name.strip_suffix(ENDING)?.split('-').collect();
        let ["step", seq, "try", attempt, "frame", index, bits, "bit", phase, view] = words[..] else {
            return None;
        };
        let depth = BitDepth::from_bits(bits.parse().ok()?)?;
        let (seq, attempt, index) = (seq.parse().ok()?, attempt.parse().ok()?, index.parse().ok()?);
        Some((Self { seq, attempt, index, depth, phase: phase.parse().ok()? }, view.parse().ok()?))
    }
}

/// Keeps in `folder` the first frames that differ in a try of a step, each with another name. `frames` are all frames
/// of the try: their names, and whether they differ; `evidence` are those that the judge has kept. What cannot be kept
/// is logged by the lane and named in [`NOT_KEPT`]; no verdict depends on it.
pub(super) fn keep(folder: &Path, place: (u32, u32), frames: &[(&str, bool)], evidence: &[Evidence]) {
    keep_as(folder, place, frames, evidence, &encoded);
}

/// Encodes a frame as the content of a file.
type Encode<'a> = &'a dyn Fn(&Frame) -> io::Result<Vec<u8>>;

fn keep_as(
    folder: &Path,
    (seq, attempt): (u32, u32),
    frames: &[(&str, bool)],
    evidence: &[Evidence],
    encode: Encode<'_>,
) {
    for (index, name) in first_that_differ(frames) {
        let is_of_it = |one: &&Evidence| {
            one.found != one.expected && frames.get(one.index).is_some_and(|(of, _)| *of == name)
        };
        let Some(one) = evidence.iter().find(is_of_it) else {
            tell(folder, &format!("step-{seq}-try-{attempt}-frame-{index}"), NotKept::LeftOut);
            continue;
        };
        let (depth, phase) = (one.expected.depth(), one.expected.phase());
        let frame = KeptFrame { seq, attempt, index: one.index, depth, phase };
        let pictures = [&one.input, &one.found, &one.expected].map(encode);
        let bytes: usize = pictures.iter().flatten().map(Vec::len).sum();
        let has_room = kept(folder) + bytes as u64 <= MOST_BYTES;
        for (view, picture) in KeptFrame::VIEWS.into_iter().zip(pictures) {
            let name = frame.name(view);
            let picture = picture.map_err(NotKept::Encode);
            let picture = picture.and_then(|png| if has_room { Ok(png) } else { Err(NotKept::NoRoom) });
            if let Err(error) = picture.and_then(|png| written(&folder.join(&name), &png)) {
                tell(folder, &name, error);
            }
        }
    }
}

/// The first frames that differ, by index and name. The same picture once more shows little else.
fn first_that_differ<'a>(frames: &[(&'a str, bool)]) -> Vec<(usize, &'a str)> {
    let mut first: Vec<(usize, &str)> = Vec::new();
    for (index, (name, differs)) in frames.iter().enumerate() {
        if *differs && first.len() < MOST_FRAMES && first.iter().all(|(_, known)| known != name) {
            first.push((index, name));
        }
    }
    first
}

fn written(path: &Path, png: &[u8]) -> Result<(), NotKept> {
    Ok(write_aside(path, true, |file| file.write_all(png))?)
}

/// Reports that something is not kept, in the place where people look for it.
pub(super) fn tell(folder: &Path, name: &str, error: NotKept) {
    let why = format!("{name} is not kept: {:#}", anyhow::Error::from(error));
    tracing::warn!("{why}");
    let list = File::options().create(true).append(true).open(folder.join(NOT_KEPT));
    if let Err(error) = list.and_then(|mut list| writeln!(list, "{why}")) {
        tracing::warn!("{NOT_KEPT} cannot be written: {error}");
    }
}

/// A frame as a PNG.
fn encoded(frame: &Frame) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    png::encode(frame, &mut bytes).map(|()| bytes).map_err(io::Error::other)
}

/// The bytes of the frames in `folder`.
fn kept(folder: &Path) -> u64 {
    let sizes = names(folder).unwrap_or_default().into_iter();
    sizes.filter_map(|name| fs::metadata(folder.join(name)).ok()).map(|known| known.len()).sum()
}

/// The names of the files of frames in `folder`, sorted.
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
    use halfrow::result::MissingRows;

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

    /// A frame with one wrong sample, at `index` in the report.
    fn wrong(index: usize) -> Evidence {
        let expected = Frame::new(8, BitDepth::Twelve, Phase::default(), vec![9; 32]).unwrap();
        let found =
            Frame::new(8, BitDepth::Twelve, Phase::default(), [vec![9; 31], vec![7]].concat()).unwrap();
        Evidence { index, input: expected.clone(), found, expected, missing: MissingRows::default() }
    }

    #[test]
    fn what_differs_is_kept_and_reads_back_and_nothing_else_is() {
        let folder = tempfile::tempdir().unwrap();
        let equal = Evidence { found: wrong(0).expected, ..wrong(0) };
        let frames = [("a", false), ("a", true), ("a", true), ("b", true), ("c", true)];
        let evidence = [equal, wrong(1), wrong(2), wrong(3), wrong(4)];
        keep(folder.path(), (2, 1), &frames, &evidence);
        let kept: Vec<_> =
            names(folder.path()).unwrap().iter().map(|name| KeptFrame::of(name).unwrap()).collect();
        let indices: Vec<_> = kept.iter().map(|(frame, _)| frame.index).collect();
        assert_eq!(indices, [1, 1, 1, 3, 3, 3], "two frames of different names, each in three views");
        let (frame, _) = &kept[0];
        let bytes = fs::read(folder.path().join(frame.name(View::Out))).unwrap();
        let how = halfrow::frames::ReadOptions {
            depth: frame.depth,
            phase: frame.phase,
            ..halfrow::frames::ReadOptions::default()
        };
        assert_eq!(halfrow::frames::decode(&bytes, &how).unwrap(), wrong(1).found);
    }

    #[test]
    fn a_picture_that_cannot_be_kept_is_named_and_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        // The disk is full for the one of the three that has another sample.
        let encode = |frame: &Frame| match frame.samples().contains(&7) {
            true => png::encode(frame, &mut [0_u8; 16].as_mut_slice())
                .map(|()| Vec::new())
                .map_err(io::Error::other),
            false => encoded(frame),
        };
        let frames = [("a", false), ("a", true), ("a", true), ("b", true)];
        keep_as(folder.path(), (2, 1), &frames, &[wrong(1), wrong(3)], &encode);
        let kept: Vec<_> =
            names(folder.path()).unwrap().iter().map(|name| KeptFrame::of(name).unwrap()).collect();
        let views: Vec<_> = kept.iter().map(|(frame, view)| (frame.index, *view)).collect();
        assert_eq!(views, [(1, View::In), (1, View::Should), (3, View::In), (3, View::Should)]);
        let told = fs::read_to_string(folder.path().join(NOT_KEPT)).unwrap();
        for (line, index) in told.lines().zip([1, 3]) {
            let frame =
                KeptFrame { seq: 2, attempt: 1, index, depth: BitDepth::Twelve, phase: Phase::default() };
            let said = format!("{} is not kept: it cannot be written as PNG", frame.name(View::Out));
            assert!(line.starts_with(&said), "{line}");
        }
        assert_eq!(told.lines().count(), 2);
    }

    #[test]
    fn the_pictures_of_a_run_take_no_more_than_32_mib() {
        for (earlier, kept) in [((32 << 20) - 10_000, 4), (32 << 20, 1)] {
            let folder = tempfile::tempdir().unwrap();
            let (depth, phase) = (BitDepth::Twelve, Phase::default());
            let first = KeptFrame { seq: 1, attempt: 1, index: 0, depth, phase };
            let file = File::create(folder.path().join(first.name(View::In))).unwrap();
            file.set_len(earlier).unwrap();
            keep(folder.path(), (2, 1), &[("a", true)], &[wrong(0)]);
            assert_eq!(names(folder.path()).unwrap().len(), kept);
            let told = fs::read_to_string(folder.path().join(NOT_KEPT)).unwrap_or_default();
            let expected = "the frames of the run take more than 33554432 bytes";
            assert_eq!(told.matches(expected).count(), 4 - kept, "{told}");
        }
    }

    #[test]
    fn a_picture_for_which_the_judge_had_no_room_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let frames = [("a", true), ("a", true), ("b", false), ("b", true), ("c", true)];
        keep(folder.path(), (2, 1), &frames, &[wrong(0), wrong(1)]);
        assert_eq!(names(folder.path()).unwrap().len(), 3);
        let told = fs::read_to_string(folder.path().join(NOT_KEPT)).unwrap();
        let expected = "step-2-try-1-frame-3 is not kept: the judge had no room for it; let its step have smaller frames\n";
        assert_eq!(told, expected, "c is the third picture");
    }
}
