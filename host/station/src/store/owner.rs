//! To whom a station's folder belongs, and what is in it.

use std::fs;
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;

use halfrow::words::plain;
use nix::errno::Errno;
use nix::unistd::{AccessFlags, Uid, User, access, geteuid};

use super::folder::log_of;
use super::{Folder, StoreError};

impl Folder {
    /// Refuses a folder that is another user's, or has something of another user's that this one may not change, as where root
    /// once worked in it. What root made among the evidence is otherwise met by one record in 256, long after the cause.
    pub(super) fn refuse_other_users(&self) -> Result<(), StoreError> {
        let (folder, database) = (self.0.clone(), self.database());
        let (log, shared) = (log_of(&database), database.with_extension("db-shm"));
        let needed = [folder, self.lock_file(), database, log, shared, self.spools(), self.evidence()];
        let evidence =
            fs::read_dir(self.evidence()).into_iter().flatten().flatten().map(|entry| entry.path());
        needed.into_iter().chain(evidence).try_for_each(|path| self.refuse_other_user(&path))
    }

    fn refuse_other_user(&self, path: &Path) -> Result<(), StoreError> {
        let Err(refused @ Errno::EACCES) = access(path, AccessFlags::W_OK) else { return Ok(()) };
        // What cannot be looked at is in a folder that was refused before it.
        let owner = fs::metadata(path).map_or(geteuid(), |about| Uid::from_raw(about.uid()));
        if owner == geteuid() {
            return Ok(());
        }
        Err(StoreError::OtherUser {
            path: path.to_owned(),
            owner: named(owner),
            user: named(geteuid()),
            folder: self.0.clone(),
            source: refused.into(),
        })
    }
}

/// A user's name, or the id of one that has none.
fn named(uid: Uid) -> String {
    match User::from_uid(uid) {
        Ok(Some(user)) => plain(&user.name).to_string(),
        _ => format!("uid {uid}"),
    }
}
