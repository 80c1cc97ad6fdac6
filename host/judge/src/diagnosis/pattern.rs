//! Where differences lie, for when no defect explains them.

use super::witnesses::{Witness, Witnesses};
use crate::compare::bits_in;
use crate::result::{Defect, Extent, FrameReport, Suspect};

/// Where the differences lie.
pub(super) fn summary(witnesses: &Witnesses<'_>) -> Suspect {
    let frames: Vec<_> =
        witnesses.case.frames.iter().filter(|frame| frame.comparison.differences > 0).collect();
    let extremes = || frames.iter().filter_map(|frame| frame.comparison.extremes);
    let defect = Defect::NoneKnown {
        rows: rows(witnesses, &frames),
        columns: columns(&frames),
        least: extremes().map(|extremes| extremes.0).min(),
        most: extremes().map(|extremes| extremes.1).max(),
        bright: brightness(&witnesses.differing),
        bits: bits(&frames),
        unstreamed: false,
        frames: frames.len(),
        of_frames: witnesses.case.frames.len(),
    };
    Suspect::explaining_nothing(defect)
}

fn rows(witnesses: &Witnesses<'_>, frames: &[&FrameReport]) -> Option<Extent> {
    let height = frames.iter().map(|frame| frame.height()).max()?;
    extent(&witnesses.rows, height)
}

fn columns(frames: &[&FrameReport]) -> Option<Extent> {
    let width = frames.iter().map(|frame| frame.comparison.by_column.len()).max()?;
    let counted =
        |frame: &FrameReport, column| frame.comparison.by_column.get(column).is_some_and(|&n| n > 0);
    let differs = |column: &usize| frames.iter().any(|frame| counted(frame, *column));
    let columns: Vec<_> = (0..width).filter(differs).collect();
    extent(&columns, width)
}

/// Which of `total` rows or columns the ascending `places` are.
fn extent(places: &[usize], total: usize) -> Option<Extent> {
    let (&first, &last) = (places.first()?, places.last()?);
    let parity = |parity| places.iter().all(|place| place % 2 == parity);
    Some(match places.len() {
        1 => Extent::One { at: first },
        count if count == total => Extent::Every {},
        count if count == last - first + 1 && last + 1 == total => Extent::From { first },
        count if count == last - first + 1 => Extent::Between { first, last },
        count if parity(0) => Extent::Even { count },
        count if parity(1) => Extent::Odd { count },
        count => Extent::Some { count, total, first, last },
    })
}

/// The bits in which any sample differs.
fn bits(frames: &[&FrameReport]) -> Vec<u32> {
    bits_in(frames.iter().fold(0, |all, frame| all | frame.comparison.bits).into())
}

/// Whether only samples that are bright in the reference differ, or only dark ones; none if both do.
fn brightness(differing: &[Witness<'_>]) -> Option<bool> {
    let half = differing.first()?.geometry().depth().max() / 2;
    let bright = |row: &Witness<'_>, bright: bool| {
        row.differing_columns().all(|column| row.expected.get(column).is_some_and(|&e| (e > half) == bright))
    };
    let all = |wanted| differing.iter().all(|row| bright(row, wanted));
    match (all(true), all(false)) {
        (true, false) => Some(true),
        (false, true) => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_told_by_what_they_have_in_common() {
        let told = |places: &[usize]| extent(places, 8).unwrap();
        assert_eq!(extent(&[], 8), None);
        assert_eq!(told(&[3]), Extent::One { at: 3 });
        assert_eq!(told(&[0, 1, 2, 3, 4, 5, 6, 7]), Extent::Every {});
        assert_eq!(told(&[5, 6, 7]), Extent::From { first: 5 });
        assert_eq!(told(&[0, 1, 2]), Extent::Between { first: 0, last: 2 });
        assert_eq!(told(&[0, 2, 6]), Extent::Even { count: 3 });
        assert_eq!(told(&[1, 7]), Extent::Odd { count: 2 });
        assert_eq!(told(&[1, 2, 7]), Extent::Some { count: 3, total: 8, first: 1, last: 7 });
    }
}
