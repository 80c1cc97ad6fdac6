//! The files that a plan names, known by the hash of what was read from each.

use std::fs::{self, File};
use std::io::Read as _;
use std::iter;
use std::path::{Path, PathBuf};

use halfrow::call::Input;
use halfrow::files::check_regular;
use halfrow::result::{FileHash, sha256};
use toml::Spanned;

use crate::input_error::Fault;

/// The files that were named so far, in order.
#[derive(Debug)]
pub(super) struct Files {
    folder: PathBuf,
    named: Vec<FileHash>,
}

impl Files {
    /// None yet, for the plan in the file `plan`, to which paths are relative.
    pub(super) fn beside(plan: &Path) -> Self {
        Self { folder: plan.parent().unwrap_or(Path::new("")).to_owned(), named: Vec::new() }
    }

    /// Finds the file `name`.
    pub(super) fn find(&self, name: &Spanned<String>) -> Result<PathBuf, Fault> {
        let path = self.folder.join(name.get_ref());
        check_regular(&path)
            .map_err(|error| Fault::input(name, format!("the file {}", path.display()), error))?;
        fs::metadata(&path).map_err(|error| {
            let what = format!("the file {} cannot be read: {error}", path.display());
            Fault::wrong(name, what, "check its name, and who may read it")
        })?;
        Ok(path)
    }

    /// Notes what was `read` from the file `name`, which must be the same each time.
    pub(super) fn note(&mut self, name: &Spanned<String>, read: Input) -> Result<(), Fault> {
        let (path, sha256) = (name.get_ref().clone(), read.sha256);
        match self.named.iter().find(|file| file.path == path) {
            Some(file) if file.sha256 == sha256 => {}
            Some(_) => {
                let what = format!("the file {} changed while the plan was read", read.path.display());
                let remedy = "read the plan again when nobody writes to its files";
                return Err(Fault::wrong(name, what, remedy));
            }
            None => self.named.push(FileHash { path, sha256 }),
        }
        Ok(())
    }

    /// All of them, and the hash of the plan's `text` together with them.
    pub(super) fn hashed(self, text: &str) -> (Vec<FileHash>, String) {
        let hash = plan_hash(text, &self.named);
        (self.named, hash)
    }
}

/// The longest file of a plan that is compared, in bytes.
const MOST_BYTES: u64 = 1 << 30;
/// How much of it is in memory at a time.
const PIECE: u64 = 1 << 20;

/// The first of these files of the plan in the file `plan` that is not what was read when they were hashed.
pub(crate) fn changed<'a>(plan: &Path, files: &'a [FileHash]) -> Option<&'a str> {
    let folder = plan.parent().unwrap_or(Path::new(""));
    let is_same =
        |file: &FileHash| hash_of(&folder.join(&file.path)).is_some_and(|sha256| sha256 == file.sha256);
    files.iter().find(|file| !is_same(file)).map(|file| file.path.as_str())
}

/// The hash of what is in the regular file `path` now, read piece by piece: whoever asks has other lanes to serve.
fn hash_of(path: &Path) -> Option<String> {
    check_regular(path).ok()?;
    let mut file = File::open(path).ok()?.take(MOST_BYTES);
    let mut is_read = true;
    let pieces = iter::from_fn(|| {
        let mut piece = Vec::new();
        is_read &= file.by_ref().take(PIECE).read_to_end(&mut piece).is_ok();
        (!piece.is_empty()).then_some(piece)
    });
    let hash = sha256(pieces);
    is_read.then_some(hash)
}

/// The SHA-256 of a plan: of its text, and of a line `path`, NUL, hash for every file that it names, in order.
pub(crate) fn plan_hash(text: &str, files: &[FileHash]) -> String {
    let lines = files.iter().map(|FileHash { path, sha256 }| format!("\n{path}\0{sha256}"));
    sha256(iter::once(text.to_owned()).chain(lines))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_changes_between_two_times_that_it_is_read_is_refused() {
        let mut files = Files::beside(Path::new("plan.toml"));
        let name = Spanned::new(0..5, "a.pgm".to_owned());
        let mut note = |bytes: &[u8]| files.note(&name, Input::of_bytes(Path::new("a.pgm"), bytes));
        note(b"one").unwrap();
        note(b"one").unwrap();
        note(b"other").unwrap_err();
        let (named, _) = files.hashed("");
        let [FileHash { path, sha256 }] = &named[..] else { panic!("{named:?}") };
        // By sha256sum.
        let one = "7692c3ad3540bb803c020b3aee66cd8887123234ea0c6e7143c0add73ff431ed";
        assert_eq!((path.as_str(), sha256.as_str()), ("a.pgm", one));
    }
}
