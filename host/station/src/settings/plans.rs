//! The plans that settings name: files, and those that the plant publishes.

use std::path::{Path, PathBuf};

use toml::Spanned;

use super::read::not_empty;
use super::{PlanFile, PlantSettings};
use crate::input_error::Fault;
use crate::plan::Plan;
use crate::published::{KeptPlans, PLACE, PublicKey, named_by};

/// Every plan that was named so far, each once.
#[derive(Debug)]
pub(super) struct Plans<'a> {
    folder: &'a Path,
    kept: KeptPlans,
    trusted: Vec<PublicKey>,
    named: Vec<PlanFile>,
}

impl<'a> Plans<'a> {
    /// No plans yet, of settings in `folder`, for the station that keeps its results in `data`.
    pub(super) fn beside(folder: &'a Path, data: &Path, plant: Option<&PlantSettings>) -> Self {
        let trusted = plant.map(|plant| plant.trusts.clone()).unwrap_or_default();
        Self { folder, kept: KeptPlans::of(data), trusted, named: Vec::new() }
    }

    /// The index of this plan among them; it is loaded when it is named first.
    pub(super) fn take(&mut self, text: &Spanned<String>) -> Result<usize, Fault> {
        not_empty(text)?;
        let (path, expected) = self.path(text)?;
        if let Some(known) = self.named.iter().position(|known| known.path == path) {
            return Ok(known);
        }
        let plan = Plan::load(&path)
            .map_err(|error| Fault::input(text, format!("the plan {}", text.get_ref()), error))?;
        if expected.is_some_and(|expected| expected != plan.sha256) {
            let what = format!("the plan {} is not as it was published", text.get_ref());
            return Err(Fault::wrong(text, what, FETCH));
        }
        self.named.push(PlanFile { path, plan });
        Ok(self.named.len() - 1)
    }

    /// Whether these take the same serial numbers: a file may have several names, and copies.
    pub(super) fn are_same(&self, one: usize, other: usize) -> bool {
        let hash = |index: usize| self.named.get(index).map(|named| &named.plan.sha256);
        hash(one) == hash(other)
    }

    /// All of them.
    pub(super) fn all(self) -> Vec<PlanFile> {
        self.named
    }

    /// Where a plan is, and which hash it must have if it is published.
    fn path(&self, text: &Spanned<String>) -> Result<(PathBuf, Option<String>), Fault> {
        let place = text.get_ref();
        if !place.starts_with(PLACE) {
            let path = self.folder.join(place);
            return Ok((std::path::absolute(&path).unwrap_or(path), None));
        }
        let Some(plan) = named_by(place) else {
            let what = format!("`{place}` is no plan of a plant");
            return Err(Fault::wrong(text, what, format!("write {PLACE}PRODUCT/NAME")));
        };
        let Some(statement) = self.kept.statement(&plan, &self.trusted) else {
            let what = format!(
                "the plan {plan} was not fetched yet, or by a key that [plant] does not trust any more"
            );
            return Err(Fault::wrong(text, what, FETCH));
        };
        Ok((self.kept.file(&statement), Some(statement.sha256)))
    }
}

const FETCH: &str = "have it fetched: halfrow-station plan fetch";
