//! The signatures that frames of a burst must have, predicted ahead of the board.

use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::Scope;

use halfrow_model::Signer;

use super::burst::BurstPlan;
use crate::reference;
use crate::run::threads::{self, NoThread};
use crate::tables::Generation;

/// The most frames that are predicted ahead of the board.
pub(super) const AHEAD: usize = 64;

/// The signatures of the frames of `plan` in order, predicted on a thread of `scope`. The thread ends when the receiver
/// is dropped.
///
/// # Errors
/// [`NoThread`] when the system gives none.
pub(super) fn ahead<'scope, 'run: 'scope>(
    scope: &'scope Scope<'scope, '_>,
    plan: BurstPlan,
    tables: &'run [Generation],
) -> Result<Receiver<u32>, NoThread> {
    let (sender, receiver) = sync_channel(AHEAD);
    threads::spawn(scope, move || {
        let mut signers: Vec<_> = tables.iter().map(signer).collect();
        let mut rows = Vec::new();
        let mut last = None;
        for n in 0..plan.frames {
            let (bank, content) = (usize::from(plan.is_of_shadow(n)), plan.content(n));
            let (Some(signer), Some(Generation { tables, .. })) = (signers.get_mut(bank), tables.get(bank))
            else {
                break;
            };
            let signature = match last {
                Some((same, signature)) if same == (bank, content) => signature,
                _ => signer.sign(tables, content, &mut rows),
            };
            last = Some(((bank, content), signature));
            if sender.send(signature).is_err() {
                break;
            }
        }
    })?;
    Ok(receiver)
}

/// A signer for frames that are made with `generation`.
pub(in crate::run) fn signer(generation: &Generation) -> Signer {
    Signer::new(reference::corrector(&generation.kernel))
}
