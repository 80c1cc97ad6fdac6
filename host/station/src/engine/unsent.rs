//! Whether too much is kept here alone for another board to be judged.

use nix::sys::statvfs::statvfs;

use crate::outbox::PlantSink;
use crate::said::{Said, Saying};
use crate::settings::Settings;
use crate::store::{Folder, Snapshot};

/// How full the disk may be, in per cent, while results wait for a plant.
const MOST_PERCENT: u64 = 95;

/// Why no other board is judged: more is unsent than the settings allow, or the disk has no room for what waits.
pub(super) fn refuses(settings: &Settings, folder: &Folder) -> Option<Said> {
    let most = settings.plant.as_ref()?.most_unsent;
    let entries = match Snapshot::take(folder).and_then(|now| now.unsent()) {
        // What others are sent is kept by the plant, too.
        Ok(unsent) => {
            unsent.iter().find(|unsent| unsent.sink == PlantSink::NAME).map_or(0, |plant| plant.entries)
        }
        Err(error) => return Some(Said::of(&error)),
    };
    if entries > most {
        return Some(Saying::TooMuchUnsent { entries, most }.into());
    }
    let percent = filled(folder).filter(|_| entries > 0)?;
    (percent >= MOST_PERCENT).then(|| Saying::DiskTooFull { percent }.into())
}

/// How full the folder's disk is, in per cent, if the system says so.
fn filled(folder: &Folder) -> Option<u64> {
    let disk = statvfs(folder.path()).ok()?;
    let (all, free) = (disk.blocks(), disk.blocks_available());
    (all > 0).then(|| 100 * all.saturating_sub(free) / all)
}
