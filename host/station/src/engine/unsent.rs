//! Whether too much is kept only here for another board to be judged.

use nix::sys::statvfs::statvfs;

use crate::said::{Said, Saying};
use crate::settings::Settings;
use crate::store::{Folder, SINK_OF_PLANT, Snapshot};

/// Why no other board is judged: more is unsent than the settings allow, or the disk has no room for what waits.
pub(super) fn refuses(settings: &Settings, folder: &Folder) -> Option<Said> {
    let plant = settings.plant.as_ref()?;
    let most = plant.most_unsent;
    // What other sinks are sent is kept by the plant, too.
    let results = match Snapshot::take(folder).and_then(|now| now.backlog(SINK_OF_PLANT)) {
        Ok(left) => left.results,
        Err(error) => return Some(Said::of(&error)),
    };
    if results > most {
        return Some(Saying::TooMuchUnsent { entries: results, most }.into());
    }
    let percent = filled(folder).filter(|_| results > 0)?;
    (percent >= plant.most_filled.into()).then(|| Saying::DiskTooFull { percent }.into())
}

/// How full the folder's disk is, in per cent, as `df` counts it, if the system says so.
fn filled(folder: &Folder) -> Option<u64> {
    let disk = statvfs(folder.path()).ok()?;
    // What is reserved for the superuser counts as neither used nor free.
    let used = disk.blocks().saturating_sub(disk.blocks_free());
    let all = used + disk.blocks_available();
    (all > 0).then(|| (100 * used).div_ceil(all))
}
