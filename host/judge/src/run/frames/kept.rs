//! The frames that are kept as evidence, within a budget of bytes.

use halfrow_model::{BitDepth, Frame};

use crate::compare::Comparison;
use crate::result::{Evidence, EvidenceReport};

/// The samples that came back in place of `expected`, as a frame. It has the greatest depth if the frame's own cannot
/// hold them.
pub(crate) fn as_found(expected: &Frame, samples: Vec<u16>) -> Option<Frame> {
    let is_held = |&depth: &BitDepth| samples.iter().all(|&sample| sample <= depth.max());
    let depth = [expected.depth(), BitDepth::Twelve].into_iter().find(is_held)?;
    Frame::new(expected.width(), depth, expected.phase(), samples).ok()
}

/// One part in this many of the budget is for counts by row and column; the rest is for frames.
const SHARE_OF_COUNTS: usize = 16;

/// A frame that may be kept.
pub(crate) struct Offered<'a> {
    /// The name of the picture in it.
    pub(crate) name: &'a str,
    pub(crate) differs: bool,
    /// Whether it is wanted for more than the diagnosis.
    pub(crate) is_wanted: bool,
    pub(crate) is_pinned: bool,
    /// The bytes of what went in, what came back and what should have.
    pub(crate) bytes: usize,
}

/// What is known about a frame that is kept.
struct Label {
    name: String,
    is_wanted: bool,
}

/// The frames that are kept of those that were streamed, in order. They include right frames whether these are wanted or not,
/// because the diagnosis must not depend on that.
#[derive(Default)]
pub(crate) struct KeptFrames {
    evidence: Vec<Evidence>,
    labels: Vec<Label>,
    bytes: usize,
    bytes_of_counts: usize,
    left_out: usize,
    /// The index of the first pinned frame, which is never replaced.
    pinned: Option<usize>,
}

impl KeptFrames {
    /// Keeps a frame if it fits into `budget` bytes with the others; `evidence` is only called then. A frame that differs
    /// replaces equal ones, the latest first, and then, if its picture is not kept yet, repetitions of other pictures,
    /// but never the pinned frame. The first pinned frame also replaces equal ones. Any other equal frame is kept only if
    /// there is room.
    pub(crate) fn offer(
        &mut self,
        offered: &Offered<'_>,
        budget: usize,
        evidence: impl FnOnce() -> Option<Evidence>,
    ) {
        if !self.make_room(offered, budget - budget / SHARE_OF_COUNTS) {
            self.left_out += usize::from(offered.is_wanted);
        } else if let Some(evidence) = evidence() {
            if offered.is_pinned {
                self.pinned.get_or_insert(evidence.index);
            }
            self.bytes += bytes(&evidence);
            self.evidence.push(evidence);
            self.labels.push(Label { name: offered.name.to_owned(), is_wanted: offered.is_wanted });
        }
    }

    /// Removes others if there is no room for a frame. Returns whether there is room then.
    fn make_room(&mut self, offered: &Offered<'_>, budget: usize) -> bool {
        while self.bytes + offered.bytes > budget {
            let Some(place) = self.place_of_another(offered) else { return false };
            let removed = self.evidence.remove(place);
            self.bytes -= bytes(&removed);
            self.left_out += usize::from(self.labels.remove(place).is_wanted);
        }
        true
    }

    /// The place of the frame that is replaced by the offered one, if any.
    fn place_of_another(
        &self,
        &Offered { name, differs: is_wrong, is_pinned, .. }: &Offered<'_>,
    ) -> Option<usize> {
        if !(is_wrong || is_pinned && self.pinned.is_none()) {
            return None;
        }
        let is_free = |place: usize| self.pinned != Some(self.evidence[place].index);
        let shows =
            |place: usize, name: &str| self.labels[place].name == name && differs(&self.evidence[place]);
        let is_there = |name: &str, before: usize| (0..before).any(|place| shows(place, name));
        let places = 0..self.evidence.len();
        let equal = places.clone().rfind(|&place| is_free(place) && !differs(&self.evidence[place]));
        equal.or_else(|| {
            let is_again = |&place: &usize| is_free(place) && is_there(&self.labels[place].name, place);
            if !is_wrong || is_there(name, places.end) { None } else { places.clone().rfind(is_again) }
        })
    }

    /// The comparison of a frame. For a frame that came back whole, the counts by row and column are dropped if they say
    /// nothing, because all is equal, or if `budget` has no room for them. For any other frame they are needed: their
    /// number shows how many rows are missing.
    pub(crate) fn shorten(&mut self, comparison: Comparison, is_whole: bool, budget: usize) -> Comparison {
        let bytes = size_of_val(&*comparison.by_row) + size_of_val(&*comparison.by_column);
        let says_nothing = comparison.differences == 0;
        let is_too_much = self.bytes_of_counts + bytes > budget / SHARE_OF_COUNTS;
        if is_whole && (says_nothing || is_too_much) {
            return Comparison { by_row: Vec::new(), by_column: Vec::new(), ..comparison };
        }
        self.bytes_of_counts += bytes;
        comparison
    }

    /// All frames that are kept at present, wanted or not.
    pub(crate) fn all(&self) -> &[Evidence] {
        &self.evidence
    }

    /// The first pinned frame.
    pub(crate) fn pinned(&self) -> Option<&Evidence> {
        self.evidence.iter().find(|evidence| Some(evidence.index) == self.pinned)
    }

    /// The wanted frames, and what the report says about them.
    pub(crate) fn finish(self) -> (Vec<Evidence>, EvidenceReport) {
        let wanted = self.evidence.into_iter().zip(self.labels).filter(|(_, label)| label.is_wanted);
        let evidence: Vec<_> = wanted.map(|(evidence, _)| evidence).collect();
        let (kept, bytes) = (evidence.len(), evidence.iter().map(bytes).sum::<usize>() as u64);
        (evidence, EvidenceReport { kept, bytes, left_out: self.left_out })
    }
}

fn differs(evidence: &Evidence) -> bool {
    evidence.found != evidence.expected
}

/// The bytes of the samples of a kept frame.
fn bytes(evidence: &Evidence) -> usize {
    let frames = [&evidence.input, &evidence.found, &evidence.expected];
    frames.into_iter().map(|frame| size_of_val(frame.samples())).sum()
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Frame, Phase};

    use super::*;
    use crate::result::MissingRows;

    /// Three frames of 64 x 2 samples, 16 bits each.
    const ONE: usize = 3 * 64 * 2 * 2;

    fn evidence(index: usize, differs: bool) -> Evidence {
        let frame = |sample| Frame::new(64, BitDepth::Twelve, Phase::Grbg, vec![sample; 2 * 64]).unwrap();
        let found = frame(2 + u16::from(differs));
        Evidence { index, input: frame(1), found, expected: frame(2), missing: MissingRows::default() }
    }

    /// The indices of the frames that are kept if there is room for `room` of them, and the number left out. `differing`
    /// says which of them differ; those at `pinned` are pinned.
    fn kept(room: usize, pinned: &[usize], differing: &[bool]) -> (Vec<usize>, usize) {
        let names: Vec<_> = (0..differing.len()).map(|index| index.to_string()).collect();
        let named: Vec<_> = names.iter().map(String::as_str).zip(differing.iter().copied()).collect();
        kept_of(room, pinned, &named)
    }

    /// The same for frames with names.
    fn kept_of(room: usize, pinned: &[usize], named: &[(&str, bool)]) -> (Vec<usize>, usize) {
        let budget = room * ONE * SHARE_OF_COUNTS / (SHARE_OF_COUNTS - 1);
        let mut kept = KeptFrames::default();
        for (index, &(name, differs)) in named.iter().enumerate() {
            let offered =
                Offered { name, differs, is_wanted: true, is_pinned: pinned.contains(&index), bytes: ONE };
            kept.offer(&offered, budget, || Some(evidence(index, differs)));
        }
        let (evidence, report) = kept.finish();
        assert_eq!((report.kept, report.bytes as usize), (evidence.len(), evidence.len() * ONE));
        (evidence.iter().map(|evidence| evidence.index).collect(), report.left_out)
    }

    #[test]
    fn what_differs_takes_the_place_of_what_is_equal_and_the_budget_holds() {
        assert_eq!(kept(3, &[], &[false, false, false, false]), (vec![0, 1, 2], 1));
        assert_eq!(kept(3, &[], &[false, true, false, true]), (vec![0, 1, 3], 1));
        assert_eq!(kept(2, &[], &[false, true, true, true, false]), (vec![1, 2], 3));
        assert_eq!(kept(2, &[0], &[false, true, true, true, false]), (vec![0, 1], 3));
        assert_eq!(kept(0, &[], &[true]), (vec![], 1));
    }

    #[test]
    fn a_picture_that_is_not_there_takes_the_place_of_one_that_is_there_twice() {
        let twice = |names: &[&'static str]| names.iter().map(|&name| (name, true)).collect::<Vec<_>>();
        assert_eq!(kept_of(2, &[], &twice(&["a", "a", "a", "b", "b", "c"])), (vec![0, 3], 4));
        assert_eq!(kept_of(3, &[], &twice(&["a", "a", "b", "c", "a", "d"])), (vec![0, 2, 3], 3));
        assert_eq!(kept_of(2, &[1], &twice(&["a", "a", "b"])), (vec![0, 1], 1));
        // An equal frame does not replace a repetition of one that differs.
        assert_eq!(kept_of(2, &[], &[("a", true), ("a", true), ("b", false)]), (vec![0, 1], 1));
    }

    #[test]
    fn a_pinned_frame_that_is_equal_takes_the_place_of_an_equal_one() {
        assert_eq!(kept(2, &[2], &[false, false, false, false]), (vec![0, 2], 2));
        assert_eq!(kept(2, &[2], &[true, true, false]), (vec![0, 1], 1));
    }

    #[test]
    fn of_pinned_frames_only_the_first_is_never_replaced() {
        assert_eq!(kept(2, &[0, 1], &[false, false, true]), (vec![0, 2], 1));
    }

    #[test]
    fn equal_frames_that_are_not_wanted_are_there_within_the_budget_until_the_end_and_nobody_is_told() {
        let budget = 2 * ONE * SHARE_OF_COUNTS / (SHARE_OF_COUNTS - 1);
        let mut kept = KeptFrames::default();
        let (mut made, indices) =
            (Vec::new(), |kept: &KeptFrames| kept.all().iter().map(|it| it.index).collect::<Vec<_>>());
        for index in 0..100 {
            let differs = index == 50;
            let offered =
                Offered { name: "noise", differs, is_wanted: differs, is_pinned: false, bytes: ONE };
            kept.offer(&offered, budget, || {
                made.push(index);
                Some(evidence(index, differs))
            });
            assert!(kept.bytes <= budget);
        }
        assert_eq!((indices(&kept), made), (vec![0, 50], vec![0, 1, 50]));
        let (evidence, report) = kept.finish();
        assert_eq!((evidence.len(), report.kept, report.bytes as usize, report.left_out), (1, 1, ONE, 0));
    }

    #[test]
    fn counts_stay_where_they_say_something_and_have_room() {
        let (mut kept, one) = (KeptFrames::default(), 4 * (64 + 2));
        let mut comparison = Comparison::new(64, 2);
        assert!(kept.shorten(comparison.clone(), true, usize::MAX).by_row.is_empty());
        comparison.row(1, &[0; 64], &[1; 64]);
        let mut counted =
            |_| !kept.shorten(comparison.clone(), true, 2 * one * SHARE_OF_COUNTS).by_row.is_empty();
        assert_eq!([0, 1, 2].map(&mut counted), [true, true, false]);
    }
}
