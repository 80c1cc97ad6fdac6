//! The plans that a station has fetched.

use std::fs::{self, FileType};
use std::io;
use std::path::{Path, PathBuf};

use halfrow::files::written_aside::{AsideFolder, Misplaced, write_aside};
use halfrow::result::sha256;

use super::bundle::{PLAN, Unpacked, keep};
use super::{BundleError, FetchError, PublicKey, Signed, Statement};
use crate::plan::{Plan, PlanName};
use crate::record::is_hash;
use crate::store::make_folder;

/// A folder of plans, each by its hash, and of what holds for each name.
#[derive(Clone, Debug)]
pub struct KeptPlans {
    folder: PathBuf,
}

impl KeptPlans {
    /// The plans of the station whose folder is `data`.
    #[must_use]
    pub fn of(data: &Path) -> Self {
        Self { folder: data.join("plans") }
    }

    /// What holds for this plan, if it was fetched and one of `trusted` has signed it.
    #[must_use]
    pub fn statement(&self, plan: &PlanName, trusted: &[PublicKey]) -> Option<Statement> {
        self.signed(plan)?.by(trusted).filter(|statement| statement.plan() == *plan)
    }

    /// The file of a plan that was fetched.
    #[must_use]
    pub fn file(&self, statement: &Statement) -> PathBuf {
        self.folder.join(&statement.sha256).join(PLAN)
    }

    /// Copies what holds and all whole plans, each with what it names, to `other`, which is empty. What holds is
    /// copied first, because a plan is written before the statement that it holds.
    ///
    /// # Errors
    /// [`BundleError`]
    pub(crate) fn copy_to(&self, other: &Self) -> Result<(), BundleError> {
        let listed = || entries(&self.folder).map_err(|source| uncopied(&self.folder, source));
        for (name, kind) in listed()? {
            if kind.is_file() && name.strip_suffix(".json").is_some_and(is_hash) {
                copy_signed(&self.folder.join(&name), &other.folder.join(&name))?;
            }
        }
        for (name, kind) in listed()? {
            if !kind.is_dir() || !is_hash(&name) {
                continue;
            }
            match self.whole(&name) {
                Some(plan) => drop(plan.write(&other.folder.join(&name))?),
                None => tracing::warn!(
                    "the plan {name} of the plant is not copied: it is not as it was published"
                ),
            }
        }
        Ok(())
    }

    /// What lies there that this program did not put there and that must not be followed: it is neither a file nor a
    /// folder.
    ///
    /// # Errors
    /// The system's reason when a folder cannot be read.
    pub(crate) fn foreign(&self) -> io::Result<Vec<PathBuf>> {
        let (mut folders, mut found) = (vec![self.folder.clone()], Vec::new());
        while let Some(folder) = folders.pop() {
            for (name, kind) in entries(&folder)? {
                let path = folder.join(name);
                if kind.is_dir() {
                    folders.push(path);
                } else if !kind.is_file() {
                    found.push(path);
                }
            }
        }
        Ok(found)
    }

    /// The plan of this hash with every file that it names, if it is exactly what the hash says.
    fn whole(&self, hash: &str) -> Option<Unpacked> {
        let file = self.folder.join(hash).join(PLAN);
        let plan = Plan::load(&file).ok().filter(|plan| plan.sha256 == hash)?;
        Unpacked::of(&file, &plan).ok()
    }

    /// Whether the plan is here with every file that it names, as it was published.
    pub(super) fn is_whole(&self, statement: &Statement) -> bool {
        Plan::load(&self.file(statement)).is_ok_and(|plan| plan.sha256 == statement.sha256)
    }

    fn signed(&self, plan: &PlanName) -> Option<Signed> {
        serde_json::from_slice(&fs::read(self.holds(plan)).ok()?).ok()
    }

    /// Where they are.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Puts the plan of this statement in place as `fill` writes it, whole or not at all. What was there of it is replaced.
    pub(super) fn put(
        &self,
        statement: &Statement,
        fill: impl FnOnce(&Path) -> Result<(), FetchError>,
    ) -> Result<(), FetchError> {
        let place = self.folder.join(&statement.sha256);
        let refused = |source| BundleError::Folder { path: place.clone(), source };
        make_folder(&self.folder).map_err(refused)?;
        let aside = AsideFolder::new(&place).map_err(refused)?;
        fill(aside.path())?;
        aside.replace(|_| Ok(None)).map_err(|misplaced| match misplaced {
            Misplaced::Io(source) => refused(source),
            Misplaced::Taken(why) => refused(io::Error::other(why)),
        })?;
        Ok(())
    }

    /// Notes that this holds from now on.
    pub(super) fn keep(&self, plan: &PlanName, signed: &Signed) -> Result<(), BundleError> {
        let text = serde_json::to_string(signed).unwrap_or_default();
        Ok(write_aside(&self.holds(plan), true, |file| file.write_all(text.as_bytes()))?)
    }

    /// The file that says what holds. Its name is a hash, because a product may have a name that no file can have.
    fn holds(&self, PlanName { product, plan }: &PlanName) -> PathBuf {
        self.folder.join(sha256([format!("{product}\0{plan}")]) + ".json")
    }
}

/// Copies what an engineer has signed, if the file has that form and still exists.
fn copy_signed(from: &Path, to: &Path) -> Result<(), BundleError> {
    match fs::read(from) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(uncopied(from, source)),
        Ok(content) if serde_json::from_slice::<Signed>(&content).is_ok() => keep(to, &content),
        Ok(_) => Ok(()),
    }
}

fn uncopied(path: &Path, source: io::Error) -> BundleError {
    BundleError::Uncopied { path: path.to_owned(), source }
}

/// What lies in a folder, which need not exist, and the type of each entry; links are not followed. What disappears
/// meanwhile is left out.
fn entries(folder: &Path) -> io::Result<Vec<(String, FileType)>> {
    let is_gone = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
    let entries = match fs::read_dir(folder) {
        Err(error) if is_gone(&error) => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut found = Vec::new();
    for entry in entries {
        let entry = entry?;
        match entry.file_type() {
            Err(error) if is_gone(&error) => {}
            kind => found.push((entry.file_name().to_string_lossy().into_owned(), kind?)),
        }
    }
    Ok(found)
}
