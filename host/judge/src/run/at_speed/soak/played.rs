//! One burst of a soak.

use crate::result::{Finding, Repetition};
use crate::run::at_speed::burst::BurstPlan;
use crate::run::at_speed::watched::BurstSeen;
use crate::run::findings::End;
use crate::tables::Generation;

/// A burst that is over or broke off.
pub(super) struct Played {
    pub(super) plan: BurstPlan,
    pub(super) tables: Vec<Generation>,
    pub(super) watched: BurstSeen,
    pub(super) ended: Result<(), End>,
}

impl Played {
    /// What differed in it, before it is looked into.
    pub(super) fn finding(&self) -> Option<Finding> {
        let BurstSeen { frames, wrong, wrong_frames, miscount, .. } = &self.watched;
        let differs = wrong_frames.first().map(|first| Finding::DiffersAtSpeed {
            wrong: (*wrong).into(),
            frames: (*frames).into(),
            first: first.n.into(),
            repetition: Repetition::NotNeeded {},
            suspect: None,
            others: 0,
            short: None,
        });
        differs.or_else(|| miscount.as_ref().map(|miscount| miscount.finding.clone()))
    }

    /// The generation of the tables that were active.
    pub(super) fn generation(&self) -> u8 {
        self.tables.first().map_or(0, |active| active.number)
    }
}
