//! The plans that a station has fetched.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use halfrow::frames::written_aside::{AsideFolder, Misplaced, write_aside};
use halfrow::result::sha256;
use serde::{Deserialize, Serialize};

use super::bundle::{PLAN, keep};
use super::{BundleError, FetchError, PublicKey, Statement};
use crate::history::PlanName;
use crate::plan::Plan;

/// A folder of plans: each by its hash, and for each name what holds.
#[derive(Clone, Debug)]
pub struct Kept {
    folder: PathBuf,
}

/// What an engineer has signed, as it is kept.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Signed {
    pub(super) statement: String,
    pub(super) signature: String,
}

impl Signed {
    /// What it says, if somebody of `trusted` has signed it.
    pub(super) fn by(&self, trusted: &[PublicKey]) -> Option<Statement> {
        Statement::signed(&self.statement, &self.signature, trusted)
    }
}

impl Kept {
    /// Of the station whose folder is `data`.
    #[must_use]
    pub fn of(data: &Path) -> Self {
        Self { folder: data.join("plans") }
    }

    /// What holds for this plan, if it was fetched and somebody of `trusted` has signed it.
    #[must_use]
    pub fn statement(&self, plan: &PlanName, trusted: &[PublicKey]) -> Option<Statement> {
        self.signed(plan)?.by(trusted).filter(|statement| statement.plan() == *plan)
    }

    /// The file of a plan that was fetched.
    #[must_use]
    pub fn file(&self, statement: &Statement) -> PathBuf {
        self.folder.join(&statement.sha256).join(PLAN)
    }

    /// Copies all of it to `other`, which has nothing yet. What holds comes before the plans, which are there before it is said that they
    /// hold.
    ///
    /// # Errors
    /// [`BundleError`]
    pub(crate) fn copy_to(&self, other: &Self) -> Result<(), BundleError> {
        if !self.folder.exists() {
            return Ok(());
        }
        let mut folders = vec![self.folder.clone()];
        while let Some(folder) = folders.pop() {
            let refused = |source| BundleError::Uncopied { path: folder.clone(), source };
            for entry in fs::read_dir(&folder).map_err(refused)? {
                let path = entry.map_err(refused)?.path();
                if path.is_dir() {
                    folders.push(path);
                } else if let Ok(name) = path.strip_prefix(&self.folder) {
                    copy(&path, &other.folder.join(name))?;
                }
            }
        }
        Ok(())
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

    /// The plan of this statement as `fill` writes it, whole or not at all. What is there of it goes.
    pub(super) fn put(
        &self,
        statement: &Statement,
        fill: impl FnOnce(&Path) -> Result<(), FetchError>,
    ) -> Result<(), FetchError> {
        let place = self.folder.join(&statement.sha256);
        let refused = |source| BundleError::Folder { path: place.clone(), source };
        fs::create_dir_all(&self.folder).map_err(refused)?;
        let aside = AsideFolder::new(&place).map_err(refused)?;
        fill(aside.path())?;
        aside.replace(|_| None).map_err(|misplaced| match misplaced {
            Misplaced::Io(source) => refused(source),
            Misplaced::Taken(why) => refused(io::Error::other(why.unwrap_or_default())),
        })?;
        Ok(())
    }

    /// From now on this holds.
    pub(super) fn keep(&self, plan: &PlanName, signed: &Signed) -> Result<(), BundleError> {
        let text = serde_json::to_string(signed).unwrap_or_default();
        Ok(write_aside(&self.holds(plan), true, |file| file.write_all(text.as_bytes()))?)
    }

    /// Where it is kept what holds; a product may be called what no file can be.
    fn holds(&self, PlanName { product, plan }: &PlanName) -> PathBuf {
        self.folder.join(sha256([format!("{product}\0{plan}")]) + ".json")
    }
}

/// Copies a file that may be an unfinished one, and gone by now.
fn copy(from: &Path, to: &Path) -> Result<(), BundleError> {
    match fs::read(from) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(BundleError::Uncopied { path: from.to_owned(), source }),
        Ok(content) => keep(to, &content),
    }
}
