//! Copies of a station's folder: the index as of one moment, the evidence that it names, as far as it can be read,
//! the records that it does not name, and the plans of the plant.

use std::collections::BTreeSet;
use std::fs::{self, DirBuilder, File, Permissions};
use std::io;
use std::os::unix::fs::{DirBuilderExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use halfrow::files::written_aside::Place;

use super::unnamed::beyond_rows;
use crate::check::{Fault, check, foreign};
use crate::progress::{Progress, Told};
use crate::published::{BundleError, KeptPlans};
use crate::record::{BlobError, Blobs, Piece, synced};
use crate::said::Said;
use crate::store::{ASIDE, Folder, LOCK, Snapshot, Store, StoreError};

/// What was copied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Copied {
    /// Runs that are over.
    pub runs: usize,
    /// Records and attachments.
    pub evidence: usize,
    /// Records of runs that have no row; what these records name is copied, too.
    pub unknown: usize,
    /// What is wrong with each piece that is left out and that is, or may be, such a record or what one names.
    pub left_out: Vec<String>,
}

/// A folder that is not copied. Nothing that looks like a copy is left then.
#[derive(Debug, thiserror::Error)]
pub enum CopyError {
    /// The folder for the copy is not empty.
    #[error("{} is there already, and is no empty folder; name another one", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// Another copy is being made in the folder, or its program was killed.
    #[error(
        "{} is there; if nobody is making a copy just now, remove it and what was already moved out of it into its folder",
        path.display()
    )]
    UnderWay {
        /// What is there.
        path: PathBuf,
    },
    /// The new folder would be inside the copy that is restored.
    #[error("{} would be inside the copy that is restored; name a folder outside it", path.display())]
    Inside {
        /// The folder.
        path: PathBuf,
    },
    /// The copy could not be written.
    #[error("{} cannot be written; check that its folder is writable and has space", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// What is to be copied is damaged: it is not as it was written.
    #[error("faults in {}: {faults}, the first: {first}; `halfrow-station check` tells all", path.display())]
    Faulty {
        /// The folder.
        path: PathBuf,
        /// How many.
        faults: usize,
        /// The first of them.
        first: String,
    },
    /// The plans of the plant.
    #[error(transparent)]
    Plans(#[from] BundleError),
    /// A store.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Copies the station in `from` to the new folder `to`. Runs may go on meanwhile; the copy is of the moment at which
/// it began. It has whatever faults the station has, which [`faults`] finds; evidence that is damaged, or cannot be read, is
/// missing in it. `told` is called for each piece that is copied.
///
/// # Errors
/// [`CopyError`]
pub fn backup(from: &Folder, to: &Path, told: Told<'_>) -> Result<Copied, CopyError> {
    Snapshot::take(from)?;
    made(to, |aside| into(from, aside, BlobError::is_withheld, told))
}

/// Makes a station's new folder `to` from the copy in `from`, if all of it is as it was written. A copy of an older
/// program's is brought up to date on the way, and keeps its old database beside the new one; `from` stays as it is.
/// `told` is called for each entry that is checked and each piece that is copied.
///
/// # Errors
/// [`CopyError`]
pub fn restore(from: &Folder, to: &Path, told: Told<'_>) -> Result<Copied, CopyError> {
    if Place::of(from.path()).holds(to) {
        return Err(CopyError::Inside { path: to.to_owned() });
    }
    match sound(from, from, told) {
        // The rest is checked once it is up to date.
        Err(CopyError::Store(StoreError::Older { .. })) => refuse(from, from, &foreign(from)?)?,
        looked_at => looked_at?,
    }
    let (is_new, mut lock) = (!to.exists(), None);
    made(to, |aside| {
        let refused = |source| CopyError::Io { path: to.to_owned(), source };
        // No station can start there before all is in place.
        let held = lock.insert(Folder::new(to).lock()?);
        if is_new {
            held.set_permissions(Permissions::from_mode(0o600)).map_err(refused)?;
        }
        let copied = into(from, aside, |error| !error.is_gone(), told)?;
        let new = Folder::new(aside);
        sound(&new, from, told)?;
        if new.lock_file().exists() {
            // It would replace the one that is held.
            fs::remove_file(new.lock_file()).map_err(refused)?;
        }
        Ok(copied)
    })
}

/// Fills the folder `to`, wholly or not at all: `fill` is given a place aside, in the folder, which keeps stations from starting there.
/// A folder that exists already remains the same one, and may be a disk of its own.
fn made(to: &Path, fill: impl FnOnce(&Path) -> Result<Copied, CopyError>) -> Result<Copied, CopyError> {
    let refused = |source| CopyError::Io { path: to.to_owned(), source };
    let to = std::path::absolute(to).map_err(refused)?;
    Folder::new(&to).refuse_path()?;
    let exists = || CopyError::Exists { path: to.clone() };
    let Some(parent) = to.parent() else { return Err(exists()) };
    let (is_there, aside) = (to.is_dir(), to.join(ASIDE));
    if aside.exists() {
        return Err(CopyError::UnderWay { path: aside });
    }
    if to.is_file() || (is_there && holds_anything(&to).map_err(refused)?) {
        return Err(exists());
    }
    if is_there {
        return filled(&to, fill);
    }
    private_folder(&to).map_err(refused)?;
    let named = synced(parent).map_err(|error| StoreError::from(error).into());
    named.and_then(|()| filled(&to, fill)).inspect_err(|_| remove_made(&to))
}

/// Fills the folder `to`, which is there.
fn filled(to: &Path, fill: impl FnOnce(&Path) -> Result<Copied, CopyError>) -> Result<Copied, CopyError> {
    let refused = |source| CopyError::Io { path: to.to_owned(), source };
    let aside = to.join(ASIDE);
    match private_folder(&aside) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            return Err(CopyError::UnderWay { path: aside });
        }
        made => made.map_err(refused)?,
    }
    let copied = fill(&aside).and_then(|copied| {
        move_all(&entries(&aside, to).map_err(refused)?, to)?;
        Ok(copied)
    });
    // The next attempt names what cannot be removed.
    let _ = fs::remove_dir_all(&aside);
    copied
}

/// Removes the folder `to`, which was made for a copy that failed, unless something else has begun in it.
fn remove_made(to: &Path) {
    if holds_anything(to).is_ok_and(|holds| !holds) {
        let _ = fs::remove_file(to.join(LOCK));
    }
    // The next attempt names what cannot be removed.
    let _ = fs::remove_dir(to);
}

/// Makes a folder that is for nobody else, whatever the umask, because a copy has all that its station keeps from others.
fn private_folder(path: &Path) -> io::Result<()> {
    DirBuilder::new().mode(0o700).create(path)
}

/// Whether `folder` has anything but what a file system is created with, and the lock that a killed restore leaves.
fn holds_anything(folder: &Path) -> io::Result<bool> {
    let names = fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect::<io::Result<Vec<_>>>()?;
    Ok(names.iter().any(|name| name != "lost+found" && name != LOCK))
}

/// What is in `aside`, and where that is to be in the folder `to`. The database is last, because without it nothing is a copy.
fn entries(aside: &Path, to: &Path) -> io::Result<Vec<(PathBuf, PathBuf)>> {
    let mut entries = fs::read_dir(aside)?
        .map(|entry| entry.map(|entry| (entry.path(), to.join(entry.file_name()))))
        .collect::<io::Result<Vec<_>>>()?;
    let database = Folder::new(aside).database();
    entries.sort_by_key(|(from, _)| *from == database);
    Ok(entries)
}

/// Moves each of these to its new place in `folder`, and brings their names there to the disk. If that fails, all are moved back.
fn move_all(moves: &[(PathBuf, PathBuf)], folder: &Path) -> Result<(), CopyError> {
    let mut moved = 0;
    let each = moves.iter().try_for_each(|(from, to)| {
        fs::rename(from, to).map_err(|source| CopyError::Io { path: folder.to_owned(), source })?;
        moved += 1;
        Ok(())
    });
    let done = each.and_then(|()| Ok(synced(folder).map_err(StoreError::from)?));
    if done.is_err() {
        for (from, to) in moves[..moved].iter().rev() {
            let _ = fs::rename(to, from);
        }
    }
    done
}

/// The faults for which [`restore`] refuses the copy in `folder`. A copy that has lost runs is otherwise as it was
/// written, and may be all that is left.
///
/// # Errors
/// [`StoreError`] when its database cannot be read at all, for which it is refused, too.
pub fn faults(folder: &Folder, told: Told<'_>) -> Result<Vec<Fault>, StoreError> {
    let mut faults = check(folder, told)?.faults;
    faults.retain(|fault| !matches!(fault, Fault::Unnamed { .. }));
    Ok(faults)
}

/// Refuses a folder in which anything is not as it was written; the error names the folder `named`, of which it is a copy.
fn sound(folder: &Folder, named: &Folder, told: Told<'_>) -> Result<(), CopyError> {
    refuse(folder, named, &faults(folder, told)?)
}

fn refuse(folder: &Folder, named: &Folder, faults: &[Fault]) -> Result<(), CopyError> {
    let [folder, name] = [folder, named].map(|folder| folder.path().display().to_string());
    match faults.first() {
        None => Ok(()),
        Some(first) => Err(CopyError::Faulty {
            path: named.path().to_owned(),
            faults: faults.len(),
            first: Said::of(first).to_string().replace(&folder, &name),
        }),
    }
}

/// Copies the station in `from` to `aside`, without the evidence that is damaged or gone unless `ends` says that the copy ends there.
fn into(
    from: &Folder,
    aside: &Path,
    ends: fn(&BlobError) -> bool,
    told: Told<'_>,
) -> Result<Copied, CopyError> {
    let to = Folder::new(aside);
    let refused = |source| CopyError::Io { path: aside.to_owned(), source };
    // Listed before the database is copied, because a run has a row before it has a record.
    let pieces = from.blobs().all().map_err(StoreError::from)?;
    from.copy_database(&to.database())?;
    let private = |file: File| {
        file.set_permissions(Permissions::from_mode(0o600))?;
        file.sync_all()
    };
    File::open(to.database()).and_then(private).map_err(refused)?;
    let spools = to.spools();
    let (blobs, plans) = (to.evidence(), KeptPlans::of(aside));
    for folder in [&spools, &blobs, plans.folder()] {
        private_folder(folder).map_err(refused)?;
    }
    KeptPlans::of(from.path()).copy_to(&plans)?;
    let copy = match Snapshot::take(&to) {
        Err(StoreError::Older { .. }) => {
            // Opening it for writing brings it up to date.
            Store::open(&to).map_err(|error| as_in(from, error))?;
            Snapshot::take(&to)?
        }
        taken => taken?,
    };
    let mut named = copy.named_evidence()?;
    named.append(&mut beyond_rows(&from.blobs(), &copy, Vec::new())?);
    copy_named(&named, [&from.blobs(), &to.blobs()], ends, told)?;
    let (unknown, left_out) = copy_unnamed(&copy, (&pieces, &named), [&from.blobs(), &to.blobs()], ends)?;
    to.blobs().sync_names().and_then(|()| synced(aside)).map_err(StoreError::from)?;
    let evidence = to.blobs().all().map_err(StoreError::from)?.len();
    Ok(Copied { runs: copy.final_runs()?.len(), evidence, unknown, left_out })
}

/// Copies the evidence in `named`. What is left out may have been removed by its age: a check of the
/// copy says whether it should be there, and all the rest may be needed one day.
fn copy_named(
    named: &BTreeSet<String>,
    [from, to]: [&Blobs; 2],
    ends: fn(&BlobError) -> bool,
    told: Told<'_>,
) -> Result<(), StoreError> {
    for (hash, done) in named.iter().zip(1..) {
        told(Progress { what: "pieces of evidence copied", done, of: Some(named.len()) });
        match from.get(hash) {
            Err(error) if ends(&error) => return Err(error.into()),
            Err(_) => {}
            Ok(bytes) => {
                to.place(&bytes)?;
            }
        }
    }
    Ok(())
}

/// Copies the records among `pieces` that no row names, and what they name; returns how many of them are of runs without a row,
/// and what is wrong with the pieces that are left out. No check of the copy would miss those.
fn copy_unnamed(
    copy: &Snapshot,
    (pieces, named): (&[Piece], &BTreeSet<String>),
    [from, to]: [&Blobs; 2],
    ends: fn(&BlobError) -> bool,
) -> Result<(usize, Vec<String>), StoreError> {
    let (mut records, mut left_out) = (Vec::new(), BTreeSet::new());
    for found in from.each_unnamed_record(pieces, named) {
        let Some(record) = unless_left_out(found, ends, &mut left_out)? else { continue };
        let Some(bytes) = unless_left_out(from.get(&record.sha256), ends, &mut left_out)? else { continue };
        to.place(&bytes)?;
        for hash in record.attachments.iter().filter(|hash| !named.contains(*hash)) {
            if let Some(bytes) = unless_left_out(from.get(hash), ends, &mut left_out)? {
                to.place(&bytes)?;
            }
        }
        records.push(record);
    }
    Ok((copy.without_row(records)?.len(), left_out.into_iter().collect()))
}

/// What was read; none if it is left out, which is noted unless it is gone.
fn unless_left_out<T>(
    read: Result<T, BlobError>,
    ends: fn(&BlobError) -> bool,
    left_out: &mut BTreeSet<String>,
) -> Result<Option<T>, BlobError> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(error) if ends(&error) => Err(error),
        Err(error) => {
            if !error.is_gone() {
                left_out.insert(Said::of(&error).to_string());
            }
            Ok(None)
        }
    }
}

/// What is wrong with the copy's database is wrong with the one that was copied.
fn as_in(from: &Folder, error: StoreError) -> StoreError {
    match error {
        StoreError::OtherSchema { version, .. } => StoreError::OtherSchema { path: from.database(), version },
        error => error,
    }
}
