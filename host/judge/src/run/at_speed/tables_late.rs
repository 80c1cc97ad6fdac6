//! Frames that begin with the tables of the frame before them, recognised by their signatures alone.

use halfrow_model::{Signer, TableSet, frame_signature};
use halfrow_protocol::message::BurstMode;

use super::burst::BurstPlan;
use super::predicted::signer;
use super::watched::{BurstSeen, WrongFrame};
use crate::result::{Defect, MadeWith, StaleFrames, Suspect};
use crate::tables::Generation;

/// The suspect, if some number of first rows of the first wrong frame, made with the tables of the other bank, give its
/// signature.
pub(super) fn tables_late(plan: &BurstPlan, tables: &[Generation], watched: &BurstSeen) -> Option<Suspect> {
    let [active, shadow] = tables else { return None };
    let mut banks = [active, shadow].map(|generation| (signer(generation), &generation.tables));
    let mut late = watched.wrong_frames.iter().map(|frame| rows_late(plan, &mut banks, frame));
    let rows = late.next()??;
    let (wrong, explained) =
        (watched.wrong_frames.len(), 1 + late.filter(|also| *also == Some(rows)).count());
    let first = watched.wrong_frames.first()?.n;
    // Before the first frame there is no other, so no change that could come late: it has the wrong tables.
    let defect =
        if first == 0 { stale(plan, [active, shadow], first) } else { Defect::TablesChangeLate { rows } };
    Some(Suspect::of_signatures(defect, wrong, explained))
}

/// The most frames of a burst in which a change is looked for: those whose row 0 is noise.
const TELLING: u32 = 32;

/// Whether a change of tables that comes a row late would have changed the signature of one of the burst's first `frames`.
pub(super) fn would_show(plan: &BurstPlan, tables: &[Generation], frames: u32) -> bool {
    let [active, shadow] = tables else { return false };
    let [Some(active), Some(shadow)] = [active.upper(1), shadow.upper(1)] else { return false };
    let mut banks = [&active, &shadow].map(|generation| (signer(generation), &generation.tables));
    let mut rows = Vec::new();
    let differ = |n| {
        let [own, other] =
            banks.each_mut().map(|(signer, tables)| signer.sign(tables, plan.content(n), &mut rows));
        own != other
    };
    // Before the first frame there is no other.
    plan.mode == BurstMode::Alternating && (1..frames.min(TELLING)).any(differ)
}

/// The defect that makes frame `n` with the tables of the other bank.
fn stale(plan: &BurstPlan, banks: [&Generation; 2], n: u32) -> Defect {
    let [own, other] =
        if plan.is_of_shadow(n) { [banks[1], banks[0]] } else { banks }.map(|bank| bank.number);
    let made_with = vec![MadeWith { factors: Some(other), kernel: Some(other) }];
    let frames = vec![StaleFrames { frame: plan.content(n).frame, committed: own, made_with }];
    Defect::StaleTables { rows: Vec::new(), frames }
}

/// How many first rows of `frame`, made with the tables of the other bank, give its signature; none if no number does.
fn rows_late(plan: &BurstPlan, banks: &mut [(Signer, &TableSet); 2], frame: &WrongFrame) -> Option<usize> {
    let content = plan.content(frame.n);
    let mut signed = banks.each_mut().map(|(signer, tables)| {
        let mut rows = Vec::new();
        signer.sign(tables, content, &mut rows);
        rows
    });
    if plan.is_of_shadow(frame.n) {
        signed.reverse();
    }
    let [mut rows, other] = signed;
    for (index, late) in other.into_iter().enumerate() {
        rows[index] = late;
        if frame_signature(&rows) == frame.found {
            return Some(index + 1);
        }
    }
    None
}
