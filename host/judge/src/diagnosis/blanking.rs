//! Rows that are wrong only if they follow each other as closely as the board says that it allows.

use super::Case;
use crate::result::{Defect, FrameReport, FrameTiming, NamedBlanking, Suspect};

/// Wrong rows in each frame with the least blanking, on average, from which on a frame without any is no chance; half of the
/// rows of a smaller frame.
const ROWS: usize = 10;

/// The suspect, if frames with the least blanking are wrong, and one with the same tables is right between them because its rows
/// are further apart. No other defect knows how far apart rows are.
pub(super) fn suspect(case: &Case<'_>) -> Option<Suspect> {
    let blanking = |frame: &FrameReport| match frame.timing {
        FrameTiming::Blanking { clocks } => Some(clocks),
        FrameTiming::LeastBlanking { .. } | FrameTiming::Gaps { .. } => None,
    };
    let place = case.frames.iter().position(|frame| blanking(frame).is_some())?;
    let (before, rest) = case.frames.split_at(place);
    let (wide, after) = rest.split_first()?;
    let right = blanking(wide)?;
    let close: Vec<_> = before.iter().filter(|frame| frame.generation == wide.generation).collect();
    let FrameTiming::LeastBlanking { clocks: named } = close.first()?.timing else { return None };
    let rows: usize = close.iter().map(|frame| frame.comparison.differing_rows().len()).sum();
    // Gaps add to the least blanking, most often too little.
    let goes_on = after.first().is_some_and(|next| next.comparison.differences > 0);
    let least = ROWS.min(wide.height() / 2) * close.len();
    let is_told = named < right && wide.comparison.differences == 0 && rows >= least && goes_on;
    let defect = Defect::LeastBlankingTooSmall(NamedBlanking { named, right });
    is_told.then(|| Suspect::explaining_nothing(defect))
}
