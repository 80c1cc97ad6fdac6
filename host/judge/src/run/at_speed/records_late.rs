//! Records that hold the signature of the frame before, recognised by their signatures alone.

use super::burst::BurstPlan;
use super::predicted::signer;
use super::watched::BurstSeen;
use crate::result::{Defect, Suspect};
use crate::tables::Generation;

/// The suspect, if the first wrong frame that has another before it has the signature that this one must have.
pub(super) fn records_late(plan: &BurstPlan, tables: &[Generation], watched: &BurstSeen) -> Option<Suspect> {
    let mut signers: Vec<_> = tables.iter().map(signer).collect();
    let mut rows = Vec::new();
    let mut before = |n: u32| {
        let n = n.checked_sub(1)?;
        let bank = usize::from(plan.is_of_shadow(n));
        let (signer, generation) = (signers.get_mut(bank)?, tables.get(bank)?);
        Some(signer.sign(&generation.tables, plan.content(n), &mut rows))
    };
    let mut late = watched.wrong_frames.iter().filter_map(|frame| Some(before(frame.n)? == frame.found));
    if !late.next()? {
        return None;
    }
    let (wrong, explained) = (watched.wrong_frames.len(), 1 + late.filter(|is_late| *is_late).count());
    Some(Suspect::of_signatures(Defect::RecordsLate {}, wrong, explained))
}
