//! Evidence stored under its own hash: a file that exists is complete, and its name is the hash of its content.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use halfrow::files::written_aside::{self, Aside, WriteAsideError};
use halfrow::result::sha256;
use nix::fcntl::OFlag;

use crate::clock;

/// Evidence that cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum BlobError {
    /// The folder for evidence cannot be made or written to the disk.
    #[error("the folder {} cannot be used; check that it is writable and has space", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file of evidence could not be written.
    #[error(transparent)]
    Write(#[from] WriteAsideError),
    /// A file of evidence could not be read.
    #[error("{} cannot be read; {}", path.display(), remedy(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file of evidence does not match the hash that is its name.
    #[error(
        "{} holds other bytes than its name says, whose hash is {found}; put the file of that name from a copy of the station's \
         folder there",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The hash of what is there.
        found: String,
    },
}

/// What to do about a file that cannot be read. One that is another user's need not be wrong, nor one that the disk, a share or
/// the limits of this program withhold for a moment.
fn remedy(source: &io::Error) -> &'static str {
    use io::ErrorKind::{InvalidInput, NotADirectory, NotFound, PermissionDenied};
    match source.kind() {
        PermissionDenied => {
            "this user may not read it: use that of the station, to whom everything in its folder must belong"
        }
        NotFound | NotADirectory | InvalidInput => {
            "put the file of that name from a copy of the station's folder there"
        }
        _ => {
            "read it again, and only if that fails too, put the file of that name from a copy of the station's folder there"
        }
    }
}

impl BlobError {
    /// Whether the evidence does not exist at all.
    #[must_use]
    pub fn is_gone(&self) -> bool {
        matches!(self, Self::Read { source, .. } if source.kind() == io::ErrorKind::NotFound)
    }

    /// Whether this program may not read the evidence, which need not be wrong.
    #[must_use]
    pub(crate) fn is_withheld(&self) -> bool {
        matches!(self, Self::Read { source, .. } if source.kind() == io::ErrorKind::PermissionDenied)
    }
}

/// A folder of evidence.
#[derive(Clone, Debug)]
pub struct Blobs {
    folder: PathBuf,
}

impl Blobs {
    /// The evidence in `folder`.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Whether there is any evidence.
    #[must_use]
    pub(crate) fn has_any(&self) -> bool {
        let is_used =
            |folder: fs::DirEntry| fs::read_dir(folder.path()).is_ok_and(|mut files| files.next().is_some());
        fs::read_dir(&self.folder).into_iter().flatten().flatten().any(is_used)
    }

    /// The path of the evidence with this hash, whether it exists or not.
    #[must_use]
    pub fn path(&self, hash: &str) -> PathBuf {
        self.folder.join(hash.get(..2).unwrap_or("00")).join(hash)
    }

    /// Writes `bytes` and syncs them and their name to the disk; returns their hash. A damaged file of that name is replaced, and so
    /// is a link; a folder is put aside.
    ///
    /// # Errors
    /// [`BlobError`]; no partial file remains.
    pub fn put(&self, bytes: &[u8]) -> Result<String, BlobError> {
        let hash = self.place(bytes)?;
        // A run that ended early may have made either without syncing its name.
        synced(self.path(&hash).parent().unwrap_or(&self.folder))?;
        synced(&self.folder)?;
        Ok(hash)
    }

    /// Like [`Self::put`] for one of many: their names are only synced by [`Self::sync_names`].
    ///
    /// # Errors
    /// Like [`Self::put`].
    pub(crate) fn place(&self, bytes: &[u8]) -> Result<String, BlobError> {
        let hash = sha256([bytes]);
        let path = self.path(&hash);
        let folder = path.parent().unwrap_or(&self.folder);
        made_within(folder).map_err(|source| BlobError::Folder { path: folder.to_owned(), source })?;
        let written = Aside::written(&path, false, |file| file.write_all(bytes));
        match written.and_then(Aside::rename_into_place) {
            // What no row names is pruned by its age, and for this run no row names it yet.
            Err(
                WriteAsideError::Exists { .. }
                | WriteAsideError::Link { .. }
                | WriteAsideError::NotAFile { .. },
            ) => {
                if is_link(&path) || self.get(&hash).is_err() || dated(&path).is_err() {
                    replace(&path, bytes)?;
                }
            }
            written => written?,
        }
        Ok(hash)
    }

    /// Syncs the names of all evidence to the disk.
    ///
    /// # Errors
    /// [`BlobError::Folder`]
    pub(crate) fn sync_names(&self) -> Result<(), BlobError> {
        let refused = |source| BlobError::Folder { path: self.folder.clone(), source };
        for entry in fs::read_dir(&self.folder).map_err(refused)? {
            synced(&entry.map_err(refused)?.path())?;
        }
        synced(&self.folder)
    }

    /// Removes the partial files of a program that was killed.
    pub fn clear(&self) {
        let folders = fs::read_dir(&self.folder).into_iter().flatten().filter_map(Result::ok);
        for kept in folders.flat_map(|folder| written_aside::clear(&folder.path())) {
            tracing::warn!("{} was kept; it is no evidence", kept.display());
        }
    }

    /// All stored evidence, whether a row names it or not. Files whose name is no hash are skipped, and so are files that
    /// disappear meanwhile.
    ///
    /// # Errors
    /// [`BlobError`] when the folder cannot be read.
    pub(crate) fn all(&self) -> Result<Vec<Piece>, BlobError> {
        let refused = |path: &Path| {
            let path = path.to_owned();
            move |source| BlobError::Folder { path, source }
        };
        let mut pieces = Vec::new();
        if !self.folder.exists() {
            return Ok(pieces);
        }
        for folder in fs::read_dir(&self.folder).map_err(refused(&self.folder))? {
            let folder = folder.map_err(refused(&self.folder))?.path();
            if !folder.is_dir() {
                continue;
            }
            for entry in fs::read_dir(&folder).map_err(refused(&folder))? {
                let entry = entry.map_err(refused(&folder))?;
                let hash = entry.file_name().to_string_lossy().into_owned();
                if !is_hash(&hash) || entry.path() != self.path(&hash) {
                    continue;
                }
                let known = match entry.metadata() {
                    Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                    known => known.map_err(refused(&folder))?,
                };
                if known.is_file() {
                    let modified = known.modified().map_err(refused(&folder))?;
                    pieces.push(Piece { hash, modified });
                }
            }
        }
        Ok(pieces)
    }

    /// The bytes of this hash.
    ///
    /// # Errors
    /// [`BlobError`] when the file cannot be read or holds other bytes.
    pub fn get(&self, hash: &str) -> Result<Vec<u8>, BlobError> {
        let path = self.path(hash);
        let bytes = read(&path).map_err(|source| BlobError::Read { path: path.clone(), source })?;
        let found = sha256([&bytes]);
        if found == hash { Ok(bytes) } else { Err(BlobError::Damaged { path, found }) }
    }

    /// Removes the evidence with this hash, and returns how many bytes it had.
    ///
    /// # Errors
    /// [`BlobError::Folder`]
    pub(crate) fn remove(&self, hash: &str) -> Result<u64, BlobError> {
        let path = self.path(hash);
        let removed = fs::metadata(&path).and_then(|known| fs::remove_file(&path).map(|()| known.len()));
        removed.map_err(|source| {
            let folder = path.parent().unwrap_or(&self.folder).to_owned();
            BlobError::Folder { path: folder, source }
        })
    }
}

/// Whether this is a link, whose file anybody may remove.
fn is_link(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|about| about.is_symlink())
}

/// Gives a file the present time.
fn dated(path: &Path) -> io::Result<()> {
    File::options().append(true).open(path)?.set_modified(SystemTime::now())
}

/// Puts evidence in the place of a file that is damaged or somebody else's: as long as that stayed there, no run with this
/// evidence could be saved.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), BlobError> {
    let is_folder = fs::symlink_metadata(path).is_ok_and(|about| about.is_dir());
    if is_folder {
        // Whatever is in it is somebody's.
        let aside = path.with_extension(format!("folder-{}", clock::now_ms()));
        fs::rename(path, &aside).map_err(|source| BlobError::Folder { path: path.to_owned(), source })?;
        tracing::warn!(
            "{} was a folder and is {} now; the evidence is written anew",
            path.display(),
            aside.display()
        );
    } else {
        tracing::warn!("{} was damaged, or is not the station's own; it is written anew", path.display());
        // What replaces a file gets its mode, which may be why it could not be read.
        let _ = fs::remove_file(path);
    }
    Ok(Aside::written(path, true, |file| file.write_all(bytes)).and_then(Aside::rename_into_place)?)
}

/// What is in a regular file. Opening a pipe in its place does not wait for somebody to write to it.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::options().read(true).custom_flags(OFlag::O_NONBLOCK.bits()).open(path)?;
    if !file.metadata()?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A file among the evidence.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Its hash, taken from its name.
    pub hash: String,
    /// When it was last written, or put again.
    pub modified: SystemTime,
}

/// Whether `name` could be that of evidence.
pub(crate) fn is_hash(name: &str) -> bool {
    name.len() == 64 && name.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

/// Makes the folder `path`, unless it is there, within one that must be there: where a station's folder was moved away, or its
/// disk unmounted, nothing is begun in its place.
pub(crate) fn made_within(path: &Path) -> io::Result<()> {
    match fs::create_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => Ok(()),
        made => made,
    }
}

/// Syncs the names in a folder to the disk.
pub(crate) fn synced(folder: &Path) -> Result<(), BlobError> {
    let done = File::open(folder).and_then(|open| open.sync_all());
    done.map_err(|source| BlobError::Folder { path: folder.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_is_found_by_its_hash_and_a_flipped_bit_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let blobs = Blobs::new(folder.path().to_owned());
        let hash = blobs.put(b"abc").unwrap();
        // FIPS 180-4, appendix B.1.
        assert_eq!(hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert_eq!(blobs.put(b"abc").unwrap(), hash);
        assert_eq!(blobs.get(&hash).unwrap(), b"abc");
        fs::write(blobs.path(&hash), b"abb").unwrap();
        assert!(matches!(blobs.get(&hash), Err(BlobError::Damaged { .. })));
        assert_eq!(blobs.put(b"abc").unwrap(), hash, "damage is not taken for evidence");
        assert_eq!(blobs.get(&hash).unwrap(), b"abc");
    }

    #[test]
    fn evidence_that_cannot_be_removed_tells_of_the_folder_around_it() {
        let folder = tempfile::tempdir().unwrap();
        let blobs = Blobs::new(folder.path().to_owned());
        let hash = blobs.put(b"abc").unwrap();
        assert_eq!(blobs.remove(&hash).unwrap(), 3);
        let BlobError::Folder { path, .. } = blobs.remove(&hash).unwrap_err() else { panic!("it is gone") };
        assert_eq!(path, folder.path().join("ba"));
    }

    #[test]
    fn evidence_is_written_where_a_folder_or_a_link_has_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let blobs = Blobs::new(folder.path().join("blobs"));
        assert!(blobs.put(b"abc").is_err() && !folder.path().join("blobs").exists(), "it is not there yet");
        fs::create_dir(folder.path().join("blobs")).unwrap();
        let path = blobs.path(&blobs.put(b"abc").unwrap());
        let other = folder.path().join("other");
        fs::rename(&path, &other).unwrap();
        for to in [other.as_path(), "nowhere".as_ref()] {
            std::os::unix::fs::symlink(to, &path).unwrap();
            blobs.put(b"abc").unwrap();
            assert!(path.symlink_metadata().unwrap().is_file(), "{}", to.display());
            fs::remove_file(&path).unwrap();
        }
        assert_eq!(fs::read(other).unwrap(), b"abc", "it is somebody else's");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("mine"), "kept").unwrap();
        assert_eq!(blobs.get(&blobs.put(b"abc").unwrap()).unwrap(), b"abc");
        let mut there = fs::read_dir(path.parent().unwrap()).unwrap().map(|entry| entry.unwrap().path());
        let aside = there.find(|found| found.is_dir()).unwrap();
        assert_eq!(fs::read_to_string(aside.join("mine")).unwrap(), "kept");
        assert_eq!(blobs.all().unwrap().len(), 1, "what was put aside is no evidence");
    }
}
