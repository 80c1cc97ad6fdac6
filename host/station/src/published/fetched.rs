//! Fetches what a plant publishes.

use std::path::Path;

use super::bundle::Unpacked;
use super::{Bundle, BundleError, KeptPlans, PublicKey, Signed, Statement};
use crate::input_error::InputError;
use crate::plan::{Plan, PlanName};
use crate::store::{Plant, StoreError};

/// A plan that was not fetched. The one that is kept stays.
#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    /// The plant.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The plant has no plan of this name.
    #[error("the plant has no plan {plan}; `halfrow-station plan published` lists those that it has")]
    None {
        /// Its product and name.
        plan: String,
    },
    /// The plan at the plant is not signed by anybody who is trusted here.
    #[error(
        "the plan {plan} of the plant is not signed by a key of `trusts` in [plant], or says something else than it was asked; nothing was \
         changed: ask whoever publishes plans"
    )]
    Untrusted {
        /// Its product and name.
        plan: String,
    },
    /// The plan at the plant is older than the one that is kept here.
    #[error(
        "the plant has the plan {plan} as its number {number}, and here is number {kept} already; nothing was changed: ask whoever keeps \
         the plant and, if its plan is to hold, publish it again until its number is above {kept}"
    )]
    Older {
        /// Its product and name.
        plan: String,
        /// The number at the plant.
        number: i64,
        /// The number here.
        kept: i64,
    },
    /// What is published is not there whole, or cannot be kept.
    #[error(transparent)]
    Bundle(#[from] BundleError),
    /// This program cannot carry out the plan at the plant.
    #[error("the plan {plan} of the plant cannot be carried out by this program; nothing was changed")]
    Plan {
        /// Its product and name.
        plan: String,
        /// Why.
        source: InputError,
    },
}

/// A plan that is kept and up to date.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fetched {
    /// What holds.
    pub statement: Statement,
    /// Whether it differs from the one before.
    pub is_new: bool,
}

/// What a plant says of a plan, signed by somebody who is trusted, and not older than what is kept.
#[derive(Debug)]
pub struct Offer {
    signed: Signed,
    statement: Statement,
    /// The text of its bundle, unless exactly that is kept already.
    bundle: Option<String>,
    is_new: bool,
}

/// Asks the plant what holds for `plan`, and for the plan itself unless it is kept as it was published. Nothing is kept yet.
///
/// # Errors
/// [`FetchError`]
pub fn offered(
    plant: &mut Plant,
    kept: &KeptPlans,
    plan: &PlanName,
    trusted: &[PublicKey],
) -> Result<Offer, FetchError> {
    let name = || plan.to_string();
    let signed = plant.publication(plan)?.ok_or_else(|| FetchError::None { plan: name() })?;
    let statement = signed.by(trusted).filter(|statement| statement.plan() == *plan);
    let statement = statement.ok_or_else(|| FetchError::Untrusted { plan: name() })?;
    // A statement whose signer is not trusted any more does not stand in the way.
    let ours = kept.statement(plan, trusted);
    let is_new = ours.as_ref() != Some(&statement);
    if let Some(ours) = ours.filter(|ours| is_new && statement.number <= ours.number) {
        return Err(FetchError::Older { plan: name(), number: statement.number, kept: ours.number });
    }
    let is_whole = !is_new && kept.is_whole(&statement);
    let bundle = if is_whole { None } else { Some(plant.bundle(&statement.sha256)?) };
    Ok(Offer { signed, statement, bundle, is_new })
}

impl Offer {
    /// Keeps it from now on.
    ///
    /// # Errors
    /// [`FetchError`]; what is kept stays as it was.
    pub fn keep(self, kept: &KeptPlans) -> Result<Fetched, FetchError> {
        let Self { signed, statement, bundle, is_new } = self;
        let Some(text) = bundle else { return Ok(Fetched { statement, is_new }) };
        let plan = Bundle::unpacked(&text, &statement.sha256)?;
        kept.put(&statement, |folder| written(&statement, &plan, folder))?;
        kept.keep(&statement.plan(), &signed)?;
        Ok(Fetched { statement, is_new })
    }
}

/// Checks that the plant has exactly the plan of this statement, with every file that it names. Nothing is kept.
///
/// # Errors
/// [`FetchError`]
pub(crate) fn look_whole(plant: &mut Plant, statement: &Statement) -> Result<(), FetchError> {
    let text = plant.bundle(&statement.sha256)?;
    let folder =
        tempfile::tempdir().map_err(|source| BundleError::Folder { path: std::env::temp_dir(), source })?;
    written(statement, &Bundle::unpacked(&text, &statement.sha256)?, folder.path())
}

/// Writes what was unpacked into `folder`, and checks that the plan read from there is the one of this statement.
fn written(statement: &Statement, unpacked: &Unpacked, folder: &Path) -> Result<(), FetchError> {
    let plan = || statement.plan().to_string();
    let file = unpacked.write(folder)?;
    let read = Plan::load(&file).map_err(|source| FetchError::Plan { plan: plan(), source })?;
    let Statement { product, name, version, sha256, .. } = statement;
    if read.sha256 != *sha256 {
        return Err(BundleError::Damaged { sha256: sha256.clone(), found: read.sha256 }.into());
    }
    if (&read.product, &read.name, &read.version) != (product, name, version) {
        return Err(FetchError::Untrusted { plan: plan() });
    }
    Ok(())
}
