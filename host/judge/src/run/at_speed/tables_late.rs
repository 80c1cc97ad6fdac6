//! Frames that begin with the tables of the frame in front of them, told by their signatures alone.

use super::burst::BurstPlan;
use super::predicted::signer;
use super::watched::{Watched, WrongFrame};
use crate::result::{Account, Defect, Suspect};
use crate::run::plan::Generation;

/// The suspect if so many first rows of the first wrong frame, made with the tables of the other bank, give its signature.
pub(super) fn tables_late(plan: &BurstPlan, tables: &[Generation], watched: &Watched) -> Option<Suspect> {
    let first = watched.wrong_frames.first().filter(|_| tables.len() > 1)?;
    let rows = rows_late(plan, tables, first)?;
    let also = |frame: &&WrongFrame| rows_late(plan, tables, frame) == Some(rows);
    let (wrong, explained) = (watched.wrong_frames.len(), watched.wrong_frames.iter().filter(also).count());
    let account = Account::Signatures { wrong, explained };
    let share = explained as f64 / wrong as f64;
    Some(Suspect { defect: Defect::TablesChangeLate { rows }, account, explained: share })
}

/// How many first rows those are.
fn rows_late(plan: &BurstPlan, tables: &[Generation], frame: &WrongFrame) -> Option<usize> {
    let content = plan.content(frame.n);
    let own = usize::from(plan.is_of_shadow(frame.n));
    let signed = |bank: usize| {
        let generation = tables.get(bank)?;
        let mut rows = Vec::new();
        signer(generation).sign(&generation.tables, content, &mut rows);
        Some(rows)
    };
    let (mut rows, other) = (signed(own)?, signed(1 - own)?);
    for (index, late) in other.into_iter().enumerate() {
        rows[index] = late;
        if halfrow_model::frame_signature(&rows) == frame.found {
            return Some(index + 1);
        }
    }
    None
}
