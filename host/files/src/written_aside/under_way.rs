//! Files and folders that are under way, under names of our own, and those that killed runs left behind.
//!
//! ```text
//! .halfrow-XXXXXXXXXX.aside           a file or folder that is worth nothing until it is whole
//! .halfrow-XXXXXXXXXX.NAME.partial    a stream for NAME that is worth keeping even if it is incomplete
//! .halfrow-NAME.claim                 some run is making NAME
//! ```
//! Each is locked by the run that made it. A lock that can be taken means that this run is gone.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::{self, DirBuilder, DirEntry, File, Metadata};
use std::io;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tempfile::NamedTempFile;

use super::lock::{self, Tried};
use super::rename;
use super::rights::Rights;
use super::temporary::Temporary;

const PREFIX: &str = ".halfrow-";
const ASIDE: &str = ".aside";
const PARTIAL: &str = ".partial";
const CLAIM: &str = ".claim";
const EARLIER: &str = ".earlier";
/// How many characters of a name are drawn at random.
const DRAWN: usize = 10;
/// The most bytes of a name that go into one of ours, so that file systems accept it.
const LONGEST: usize = 200;
/// How often a name is drawn anew if another run mistook the new file for one of a dead run.
const TRIES: usize = 100;

static UNDER_WAY: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn under_way() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Something of this run that [`abandon_all`] would remove, until this is dropped.
#[derive(Debug)]
pub(super) struct Noted(PathBuf);

impl Noted {
    /// Notes something that is already made.
    pub(super) fn new(path: PathBuf) -> Self {
        under_way().insert(path.clone());
        Self(path)
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Noted {
    fn drop(&mut self) {
        under_way().remove(&self.0);
    }
}

/// Makes something and notes it. [`abandon_all`] cannot come between the two.
fn made<T>(make: impl FnOnce() -> io::Result<(T, PathBuf)>) -> io::Result<(T, Noted)> {
    let mut under_way = under_way();
    let (made, path) = make()?;
    under_way.insert(path.clone());
    Ok((made, Noted(path)))
}

/// What [`abandon_all`] found.
#[derive(Debug)]
pub struct Abandoned {
    /// Whether anything was under way.
    pub is_any: bool,
    /// Where streams that are worth keeping now are, as far as they go.
    pub kept: Vec<PathBuf>,
}

/// Removes everything that is under way, for a program that must end at once, and lets nothing new begin. Streams that are
/// worth keeping get a name that is free.
pub fn abandon_all() -> Abandoned {
    let under_way = under_way();
    let mut abandoned = Abandoned { is_any: !under_way.is_empty(), kept: Vec::new() };
    for path in under_way.iter() {
        if is_worth_keeping(path) && fs::metadata(path).is_ok_and(|about| about.len() > 0) {
            abandoned.kept.push(kept(path).unwrap_or_else(|_| path.clone()));
        } else {
            let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }
    std::mem::forget(under_way);
    abandoned
}

/// A locked file in `folder`, with the given rights or ordinary ones. If it is worth keeping, `kept_for` is the name that it is
/// kept for.
pub(super) fn file(
    folder: &Path,
    kept_for: Option<&OsStr>,
    rights: Option<Rights>,
) -> io::Result<(NamedTempFile, Noted)> {
    let suffix = kept_for.map_or_else(
        || OsString::from(ASIDE),
        |name| [OsStr::new("."), shortened(name), OsStr::new(PARTIAL)].into_iter().collect(),
    );
    for _ in 0..TRIES {
        let (file, noted) = made(|| {
            let mut options = File::options();
            options.read(true).write(true).create_new(true).mode(rights.map_or(0o666, Rights::mode));
            let file = builder(&suffix).make_in(folder, |path| options.open(path))?;
            let path = file.path().to_owned();
            Ok((file, path))
        })?;
        if is_ours(file.as_file(), file.path()) {
            rights.map_or(Ok(()), |rights| rights.give(file.as_file()))?;
            return Ok((file, noted));
        }
    }
    Err(io::ErrorKind::ResourceBusy.into())
}

/// A locked folder in `parent`, with the given rights or ordinary ones, and the file that holds its lock.
pub(super) fn folder(parent: &Path, rights: Option<Rights>) -> io::Result<(Temporary, File, Noted)> {
    for _ in 0..TRIES {
        let (folder, noted) = made(|| {
            let mut options = DirBuilder::new();
            options.mode(rights.map_or(0o777, Rights::mode));
            let made = builder(OsStr::new(ASIDE)).make_in(parent, |path| options.create(path))?;
            let path = made.into_temp_path().keep()?;
            Ok((Temporary::new(path.clone()), path))
        })?;
        match lock::open(folder.path()) {
            Ok(held) if is_ours(&held, folder.path()) => {
                rights.map_or(Ok(()), |rights| rights.give(&held))?;
                return Ok((folder, held, noted));
            }
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Err(io::ErrorKind::ResourceBusy.into())
}

/// Draws names. What `tempfile` itself makes comes with errors that hide the system's number, by which a full disk is told from a
/// wrong place.
fn builder(suffix: &OsStr) -> tempfile::Builder<'static, '_> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).rand_bytes(DRAWN).suffix(suffix);
    builder
}

/// Takes the lock of what was just made. False if a run that cleans up was faster and removed it.
fn is_ours(made: &File, path: &Path) -> bool {
    match lock::try_lock(made) {
        Tried::Theirs => false,
        Tried::Ours | Tried::Unknown => lock::is_named(made, path),
    }
}

/// The path of the file that claims `target`.
pub(super) fn claim_on(target: &Path) -> PathBuf {
    let name = shortened(target.file_name().unwrap_or_default());
    let parts = [OsStr::new(PREFIX), name, OsStr::new(CLAIM)];
    super::folder_of(target).join(parts.into_iter().collect::<OsString>())
}

/// The beginning of a name, short enough to append to.
fn shortened(name: &OsStr) -> &OsStr {
    OsStr::from_bytes(&name.as_bytes()[..name.len().min(LONGEST)])
}

/// Clears `folder` of what killed runs left in it. Streams that are worth keeping get a name that is free; these names are
/// returned. What cannot be identified or removed stays.
#[must_use]
pub fn clear(folder: &Path) -> Vec<PathBuf> {
    ours(folder).filter_map(|entry| clear_one(&entry.path())).collect()
}

/// Clears `folder`, to which other computers may write, of files that killed runs left in it and that were worth nothing until they
/// were whole. Not every file system shows one computer the locks of another, so files stay that were written within `age`.
pub fn clear_older(folder: &Path, age: Duration) {
    let is_old = |entry: &DirEntry| {
        let about = entry.metadata().ok().filter(Metadata::is_file);
        let written = about.and_then(|about| about.modified().ok());
        written.and_then(|written| written.elapsed().ok()).is_some_and(|past| past >= age)
    };
    let is_aside = |entry: &DirEntry| entry.file_name().as_bytes().ends_with(ASIDE.as_bytes());
    let left = ours(folder).filter(|entry| is_aside(entry) && is_old(entry));
    left.for_each(|entry| drop(clear_one(&entry.path())));
}

/// What runs write in `folder`, or have left there.
fn ours(folder: &Path) -> impl Iterator<Item = DirEntry> {
    fs::read_dir(folder).into_iter().flatten().flatten().filter(is_one_of_ours)
}

fn clear_one(path: &Path) -> Option<PathBuf> {
    let file = lock::open(path).ok()?;
    let (Tried::Ours, true) = (lock::try_lock(&file), lock::is_named(&file, path)) else { return None };
    let about = file.metadata().ok()?;
    if about.is_dir() {
        let _ = fs::remove_dir_all(path);
        None
    } else if is_worth_keeping(path) && about.len() > 0 {
        let told = |error: &_| tracing::warn!(path = %path.display(), %error, "it is worth keeping, and stays as it is");
        kept(path).inspect_err(told).ok()
    } else {
        let _ = fs::remove_file(path);
        None
    }
}

/// Whether it has one of our names and is of the kind that the name says.
fn is_one_of_ours(entry: &DirEntry) -> bool {
    let name = entry.file_name();
    let Some(rest) = name.as_bytes().strip_prefix(PREFIX.as_bytes()) else { return false };
    let Ok(about) = entry.metadata() else { return false };
    let is_drawn = rest.len() > DRAWN && rest[..DRAWN].iter().all(u8::is_ascii_alphanumeric);
    let drawn = is_drawn.then(|| &rest[DRAWN..]);
    let is_partial = |rest: &[u8]| rest.starts_with(b".") && rest.ends_with(PARTIAL.as_bytes());
    match drawn {
        Some(rest) if rest == ASIDE.as_bytes() => about.is_file() || about.is_dir(),
        Some(rest) if is_partial(rest) => about.is_file(),
        _ => rest.ends_with(CLAIM.as_bytes()) && about.is_file() && about.len() == 0,
    }
}

fn is_worth_keeping(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == &PARTIAL[1..])
}

/// Gives a stream that ended early its final name, NAME.partial, with a number if that is taken.
pub(super) fn kept(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().unwrap_or_default().as_bytes();
    to_free_name(path, OsStr::from_bytes(name.get(PREFIX.len() + DRAWN + 1..).unwrap_or(name)))
}

/// Renames what was in the place `target`, and is at `path` now, to NAME.earlier, with a number if that is taken. Under a name of
/// ours a later run would remove it.
pub(super) fn spare(path: &Path, target: &Path) -> io::Result<PathBuf> {
    let name = shortened(target.file_name().unwrap_or_default());
    to_free_name(path, &[name, OsStr::new(EARLIER)].into_iter().collect::<OsString>())
}

/// Renames `path` to `name` in the same folder, with a number if that is taken.
fn to_free_name(path: &Path, name: &OsStr) -> io::Result<PathBuf> {
    for number in 1..1000 {
        let mut name = name.to_owned();
        if number > 1 {
            name.push(format!("-{number}"));
        }
        let place = path.with_file_name(name);
        match rename::to_new(path, &place) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            renamed => return renamed.map(|()| place),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}
