//! A plan with every file that it names, as one text.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use halfrow::files::written_aside::{WriteAsideError, write_aside};
use halfrow::result::{FileHash, sha256};
use serde::{Deserialize, Serialize};

use crate::plan::{Plan, plan_hash};

/// The version of the bundle's own format.
const SCHEMA: u32 = 1;
/// The most bytes of all files together.
const MOST: u64 = 64 << 20;
/// The name of a plan's file once it is unpacked.
pub(super) const PLAN: &str = "plan.toml";

/// A plan that cannot be published or unpacked.
#[derive(Debug, thiserror::Error)]
pub enum BundleError {
    /// The plan names a file outside its own folder.
    #[error("the plan names {name}, which lies outside of its folder; put it beside the plan")]
    Outside {
        /// The name.
        name: String,
    },
    /// The plan names a file that would take the place of the plan itself.
    #[error(
        "the plan names a file {PLAN}, which it is called itself where it is unpacked; give that file another name"
    )]
    Plan,
    /// The plan names a file with control characters in its name, so that nobody could tell where the name ends.
    #[error("the plan names {name:?}, which has control characters; give that file another name")]
    Control {
        /// The name.
        name: String,
    },
    /// The files that the plan names are too large together.
    #[error("the plan's files have {bytes} bytes, and {MOST} may be; give fewer or smaller frames")]
    TooLarge {
        /// All of them.
        bytes: u64,
    },
    /// A file that the plan names was changed or removed since the plan was read.
    #[error("the file {} is not as it was when the plan was read; publish it again", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
        /// The system's reason, if it has one.
        source: Option<io::Error>,
    },
    /// The plan at the plant is not in the form that a published plan has.
    #[error("the plant's plan {sha256} is not a plan; publish it again, and ask whoever keeps the plant")]
    Malformed {
        /// The hash.
        sha256: String,
    },
    /// The plan at the plant does not match its hash.
    #[error(
        "the plant's plan {sha256} has the hash {found}; publish it again, and ask whoever keeps the plant"
    )]
    Damaged {
        /// The hash that it should have.
        sha256: String,
        /// The one that it has.
        found: String,
    },
    /// The plan cannot be written to the folder where it is to be kept.
    #[error("the plan cannot be kept in {}; check that the folder is writable and has space", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The plans that are kept of the plant cannot be read to be copied.
    #[error("{}, in which the plans of the plant are kept, cannot be read; check who may read it", path.display())]
    Uncopied {
        /// The file or the folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file of a plan that was fetched from the plant cannot be written.
    #[error(transparent)]
    Unwritten(#[from] WriteAsideError),
}

/// A plan with its files.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bundle {
    schema: u32,
    text: String,
    files: Vec<BundledFile>,
}

/// A file that the plan names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BundledFile {
    path: String,
    base64: String,
}

impl Bundle {
    /// The plan that was read from the file `path`, with all that it names.
    ///
    /// # Errors
    /// [`BundleError`]
    pub fn of(path: &Path, plan: &Plan) -> Result<Self, BundleError> {
        let Unpacked { text, files } = Unpacked::of(path, plan)?;
        let bundled =
            |(path, content)| BundledFile { path, base64: BASE64_STANDARD.encode::<Vec<u8>>(content) };
        Ok(Self { schema: SCHEMA, text, files: files.into_iter().map(bundled).collect() })
    }

    /// The bundle as text.
    #[must_use]
    pub fn text(&self) -> String {
        // It has nothing that JSON could not express.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Unpacks the bundle `text`, whose plan has the hash `expected`.
    ///
    /// # Errors
    /// [`BundleError`] when it is not what its hash says.
    pub(super) fn unpacked(text: &str, expected: &str) -> Result<Unpacked, BundleError> {
        let malformed = || BundleError::Malformed { sha256: expected.to_owned() };
        let Self { schema, text, files } = serde_json::from_str(text).map_err(|_| malformed())?;
        if schema != SCHEMA {
            return Err(malformed());
        }
        let mut unpacked = Vec::new();
        let mut hashes = Vec::new();
        for BundledFile { path, base64 } in files {
            check_name(&path).map_err(|_| malformed())?;
            let content = BASE64_STANDARD.decode(base64).map_err(|_| malformed())?;
            hashes.push(FileHash { path: path.clone(), sha256: sha256([&content]) });
            unpacked.push((path, content));
        }
        let found = plan_hash(&text, &hashes);
        if found != expected {
            return Err(BundleError::Damaged { sha256: expected.to_owned(), found });
        }
        Ok(Unpacked { text, files: unpacked })
    }
}

/// A plan, and its files by their names.
#[derive(Debug)]
pub(super) struct Unpacked {
    text: String,
    files: Vec<(String, Vec<u8>)>,
}

impl Unpacked {
    /// The plan that was read from the file `path`, with all that it names.
    pub(super) fn of(path: &Path, plan: &Plan) -> Result<Self, BundleError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let (mut files, mut bytes) = (Vec::new(), 0);
        for FileHash { path: name, sha256: hash } in &plan.files {
            check_name(name)?;
            let path = folder.join(name);
            let changed = |source| BundleError::Changed { path: path.clone(), source };
            let content = fs::read(&path).map_err(|source| changed(Some(source)))?;
            if sha256([&content]) != *hash {
                return Err(changed(None));
            }
            bytes += content.len() as u64;
            if bytes > MOST {
                return Err(BundleError::TooLarge { bytes });
            }
            files.push((name.clone(), content));
        }
        Ok(Self { text: plan.text.clone(), files })
    }

    /// Writes it into `folder`, and returns the path of the plan's file.
    ///
    /// # Errors
    /// [`BundleError`] when it cannot be kept.
    pub(super) fn write(&self, folder: &Path) -> Result<PathBuf, BundleError> {
        for (name, content) in &self.files {
            keep(&folder.join(name), content)?;
        }
        let plan = folder.join(PLAN);
        keep(&plan, self.text.as_bytes())?;
        Ok(plan)
    }
}

/// A file of a bundle lies next to the plan, or below. The plan's hash separates names by newlines and NULs, so no
/// name may have these.
fn check_name(name: &str) -> Result<(), BundleError> {
    if name == PLAN {
        return Err(BundleError::Plan);
    }
    if name.contains(char::is_control) {
        return Err(BundleError::Control { name: name.to_owned() });
    }
    let is_below = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
    if is_below && !name.is_empty() { Ok(()) } else { Err(BundleError::Outside { name: name.to_owned() }) }
}

/// Writes the file, unless it has exactly this content already.
pub(super) fn keep(path: &Path, content: &[u8]) -> Result<(), BundleError> {
    if fs::read(path).is_ok_and(|there| there == content) {
        return Ok(());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(|source| BundleError::Folder { path: folder.to_owned(), source })?;
    Ok(write_aside(path, true, |file| file.write_all(content))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The hash is right, because whoever has a trusted key could sign such a bundle.
    #[test]
    fn nothing_is_unpacked_that_would_lie_outside_of_its_folder_or_over_the_plan() {
        let unpacked = |name: &str| {
            let hash = FileHash { path: name.to_owned(), sha256: sha256([b"x"]) };
            let file = BundledFile { path: name.to_owned(), base64: BASE64_STANDARD.encode("x") };
            let bundle = Bundle { schema: SCHEMA, text: "text".to_owned(), files: vec![file] };
            Bundle::unpacked(&bundle.text(), &plan_hash("text", &[hash]))
        };
        for name in ["../../outside", "/outside", "a/../b", "", PLAN, "a\nb"] {
            assert!(matches!(unpacked(name), Err(BundleError::Malformed { .. })), "{name}");
        }
        // The control.
        assert!(unpacked("a/b").is_ok());
    }

    #[test]
    fn a_plan_with_more_than_64_mib_of_files_is_not_bundled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.toml");
        let text = include_str!("../../tests/station/quick.toml").to_owned();
        let mut plan = Plan::parse(&path, text).unwrap();
        for (more, is_taken) in [(0, true), (1, false)] {
            let frames = fs::File::create(folder.path().join("frames")).unwrap();
            frames.set_len((64 << 20) + more).unwrap();
            let sha256 = sha256([fs::read(folder.path().join("frames")).unwrap()]);
            plan.files = vec![FileHash { path: "frames".to_owned(), sha256 }];
            let refused = Unpacked::of(&path, &plan).err();
            let is_large = matches!(refused, Some(BundleError::TooLarge { bytes: 67_108_865 }));
            assert_eq!((refused.is_none(), is_large), (is_taken, !is_taken), "{refused:?}");
        }
    }

    #[test]
    fn a_bundle_of_a_later_format_is_not_taken_for_one_of_this() {
        let unpacked = |schema| {
            let bundle = Bundle { schema, text: "text".to_owned(), files: Vec::new() };
            Bundle::unpacked(&bundle.text(), &plan_hash("text", &[]))
        };
        assert!(matches!(unpacked(2), Err(BundleError::Malformed { .. })));
        // The control.
        assert!(unpacked(1).is_ok());
    }
}
