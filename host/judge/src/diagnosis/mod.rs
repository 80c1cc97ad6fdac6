//! From the pattern of differences to the broken part.
//!
//! ```text
//! Case ─► witnesses ─► families ─► ranking ─► Suspect
//!         rows to      single      simulates each defect on the rows,
//!         explain      defects     sample by sample, and keeps the best
//! ```
//!
//! Nearly every suspect is a single defect that was simulated: from the tables and what entered or, where it moves, loses or mixes
//! rows, from what was found as well. Its share says how many of the differing samples it predicts to the bit. Too small a blanking
//! is told by which frames are wrong, and predicts none. Where nothing explains the samples, [`diagnose`] describes where they
//! lie and names no part.

mod blanking;
mod datapath;
mod families;
mod hypothesis;
mod pattern;
mod ranking;
mod read_back;
mod witnesses;

use crate::result::{Evidence, FrameReport, Suspect};
use crate::tables::Generation;
use witnesses::Witnesses;

pub use read_back::read_back;

/// Everything that is known about a board that computes wrongly.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    /// All that was uploaded, in order.
    pub uploaded: &'a [Generation],
    /// M, the samples of line memory.
    pub ring: usize,
    /// Every frame, in streaming order.
    pub frames: &'a [FrameReport],
    /// Frames that were kept, including those that differ.
    pub evidence: &'a [Evidence],
}

impl<'a> Case<'a> {
    /// What was uploaded under this generation last.
    fn uploaded_as(&self, generation: u8) -> Option<&'a Generation> {
        self.uploaded.iter().rfind(|uploaded| uploaded.number == generation)
    }
}

/// Lines of the address of a memory of so many entries.
fn address_bits(entries: usize) -> u32 {
    usize::BITS - entries.saturating_sub(1).leading_zeros()
}

/// The defects that explain the differences best, at most three, the likeliest first; none if nothing differs.
///
/// If several explain all of them, their evidence says so. Where no defect explains most of them, the first suspect is `unknown`
/// and describes where they lie; but too small a blanking comes before any that does not explain all of them.
#[must_use]
pub fn diagnose(case: &Case<'_>) -> Vec<Suspect> {
    let witnesses = Witnesses::of(case);
    if witnesses.rows.is_empty() {
        return Vec::new();
    }
    let mut ranked = ranking::rank(&witnesses, families::propose(&witnesses));
    if !ranked.first().is_some_and(|best| best.score.is_exact()) {
        let searched = ranking::rank(&witnesses, families::search(&witnesses));
        ranked = ranking::merge(ranked, searched);
    }
    let mut suspects = ranking::suspects(&ranked, || pattern::summary(&witnesses));
    if !ranked.first().is_some_and(|best| best.score.is_exact()) {
        suspects.splice(0..0, blanking::suspect(case));
    }
    suspects.truncate(ranking::NAMED);
    suspects
}
