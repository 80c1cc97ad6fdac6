//! Whether too much is kept only here for another board to be judged.

use crate::disk::Room;
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
    let percent = Room::of(folder.path()).ok()?.filled().filter(|_| results > 0)?;
    (percent >= plant.most_filled.into()).then(|| Saying::DiskTooFull { percent }.into())
}
