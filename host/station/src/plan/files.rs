//! The files that a plan names, each read and hashed once.

use std::fs;
use std::path::{Path, PathBuf};

use halfrow::frames::check_regular;
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
    /// Of the plan in the file `plan`, to which paths are relative.
    pub(super) fn beside(plan: &Path) -> Self {
        Self { folder: plan.parent().unwrap_or(Path::new("")).to_owned(), named: Vec::new() }
    }

    /// Where the file `name` is. It is hashed if it was not before.
    pub(super) fn take(&mut self, name: &Spanned<String>) -> Result<PathBuf, Fault> {
        let path = self.folder.join(name.get_ref());
        if self.named.iter().any(|file| file.path == *name.get_ref()) {
            return Ok(path);
        }
        let at = name.span().start;
        check_regular(&path)
            .map_err(|error| Fault::input(at, format!("the file {}", path.display()), error))?;
        let bytes = fs::read(&path).map_err(|error| {
            let what = format!("the file {} cannot be read: {error}", path.display());
            Fault::wrong(at, what, "check its name, and who may read it")
        })?;
        self.named.push(FileHash { path: name.get_ref().clone(), sha256: sha256([bytes]) });
        Ok(path)
    }

    /// All of them, and the hash of the plan's `text` with them.
    pub(super) fn hashed(self, text: &str) -> (Vec<FileHash>, String) {
        let hash = plan_hash(text, &self.named);
        (self.named, hash)
    }
}

/// SHA-256 of a plan: of its text, and of a line `path`, NUL, hash for every file that it names, in order.
pub(crate) fn plan_hash(text: &str, files: &[FileHash]) -> String {
    let lines = files.iter().map(|FileHash { path, sha256 }| format!("\n{path}\0{sha256}"));
    sha256(std::iter::once(text.to_owned()).chain(lines))
}
