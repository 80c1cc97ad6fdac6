//! What `halfrow-station plan` does with plans that the plant publishes.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::beginning::SettingsFile;
use super::fetching::{address, published};
use super::looking::{either, table, time};
use super::why::{Why, entered_at};
use super::{Failure, print, tell};
use crate::exit::Exit;
use crate::plan::{Plan, PlanName};
use crate::published::{Bundle, PublicKey, Signed, SigningKey, Statement, look_whole};
use crate::store::{Plant, PlantLink, publications};

/// Publish a plan with its files at the plant: every station that names it takes it when it starts next
#[derive(Debug, Args)]
pub(super) struct Publish {
    #[command(flatten)]
    settings: SettingsFile,
    /// The plan
    file: PathBuf,
    #[command(flatten)]
    signer: Signer,
}

/// Make an earlier version of a plan the valid one again
#[derive(Debug, Args)]
pub(super) struct Back {
    #[command(flatten)]
    settings: SettingsFile,
    /// The product and the plan's name, with a slash between
    plan: String,
    /// The version
    #[arg(value_name = "VERSION")]
    earlier: String,
    #[command(flatten)]
    signer: Signer,
}

/// Who publishes.
#[derive(Debug, Args)]
struct Signer {
    /// The engineer's key, as `plan key` makes it
    #[arg(long, value_name = "FILE")]
    key: PathBuf,
    #[command(flatten)]
    why: Why,
}

/// Print the plans that are valid at the plant
#[derive(Debug, Args)]
pub(super) struct List {
    #[command(flatten)]
    settings: SettingsFile,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// A plan that is not published.
#[derive(Debug, thiserror::Error)]
pub(super) enum PublishError {
    /// The plant has another plan with this name and version.
    #[error(
        "the plant has another plan {plan} {version}, which runs may have been judged by; give this one a version of its own"
    )]
    OtherContent { plan: String, version: String },
    /// Somebody else published the plan at the same time.
    #[error(
        "somebody else published the plan {plan} just now; look at `halfrow-station plan published`, and publish yours again"
    )]
    TooLate { plan: String },
    /// This version of the plan was never published.
    #[error(
        "the plant never had a plan {plan} {version}; `halfrow-station plan published` lists those that hold"
    )]
    NoVersion { plan: String, version: String },
    /// The plan at the plant is signed by a key that is not trusted here.
    #[error(
        "the plant's plan {plan} is signed neither by this key nor by one of `trusts` in [plant]; write the key \
         there if you know whose it is, and ask whoever keeps the plant if not"
    )]
    Untrusted { plan: String },
    /// The plan cannot be published because its product has a slash: settings name a plan by its product and its name with a
    /// slash between.
    #[error(
        "the product `{product}` has a slash, which would end it in settings; give the plan a product without a slash"
    )]
    Slash { product: String },
    /// The plan was published so often that no number is left for it.
    #[error("the plan {plan} has had the last number that there is; publish it under another name")]
    NoNumber { plan: String },
}

/// Makes an engineer's key in a new file, and prints what stations know it by.
pub(super) fn key(file: &Path) -> Result<Exit, Failure> {
    let key = SigningKey::draw(file)?;
    let shown = print(&key.public().to_string());
    if shown.is_err() {
        // No station can be told of it.
        fs::remove_file(file).map_err(Failure::error)?;
    }
    shown
}

pub(super) fn publish(Publish { settings, file, signer }: &Publish) -> Result<Exit, Failure> {
    let plan = Plan::load(file)?;
    let bundle = Bundle::of(file, &plan)?;
    let name = PlanName::from(&plan);
    if name.product.contains('/') {
        return Err(Failure::call(PublishError::Slash { product: name.product }));
    }
    let mut desk = signer.desk(settings)?;
    // Whoever signed it, runs may have been judged by it.
    let before = desk.at.published_version(&name, &plan.version)?;
    let is_other = |before: &Signed| {
        serde_json::from_str(&before.statement).map_or(true, |before: Statement| before.sha256 != plan.sha256)
    };
    if before.as_ref().is_some_and(is_other) {
        let version = plan.version.clone();
        return Err(Failure::call(PublishError::OtherContent { plan: name.to_string(), version }));
    }
    let given = format!("plan publish {name}");
    desk.state(&given, &name, &plan.version, &plan.sha256, Some(&bundle))
}

pub(super) fn back(Back { settings, plan, earlier: version, signer }: &Back) -> Result<Exit, Failure> {
    let none = || Failure::call(PublishError::NoVersion { plan: plan.clone(), version: version.clone() });
    let (product, name) = plan.split_once('/').ok_or_else(none)?;
    let name = PlanName { product: product.to_owned(), plan: name.to_owned() };
    let mut desk = signer.desk(settings)?;
    let said = desk.at.published_version(&name, version)?.ok_or_else(none)?;
    let statement = desk.trusted(&name, &said)?;
    if statement.version != *version {
        return Err(Failure::error(PublishError::Untrusted { plan: plan.clone() }));
    }
    look_whole(&mut desk.at, &statement)?;
    desk.state(&format!("plan back {name} {version}"), &name, version, &statement.sha256, None)
}

impl Signer {
    /// The desk at the plant that the settings name.
    fn desk(&self, settings: &SettingsFile) -> Result<Desk<'_>, Failure> {
        let published = published(settings)?;
        let key = SigningKey::load(&self.key)?;
        let trusted = [published.trusts(), &[key.public()]].concat();
        Ok(Desk { at: Plant::connect(&address(&published)?)?, key, trusted, why: &self.why })
    }
}

/// The plant, with an engineer in front of it who has a key. What its database says counts only as far as it is signed.
struct Desk<'a> {
    at: Plant,
    key: SigningKey,
    /// Whose statements are accepted: the engineer's own, and those of the people whom the settings trust.
    trusted: Vec<PublicKey>,
    why: &'a Why,
}

impl Desk<'_> {
    /// What was stated about this plan, if somebody who is trusted signed it.
    fn trusted(&self, name: &PlanName, said: &Signed) -> Result<Statement, Failure> {
        said.by(&self.trusted)
            .filter(|statement| statement.plan() == *name)
            .ok_or_else(|| Failure::error(PublishError::Untrusted { plan: name.to_string() }))
    }

    /// The number of the next statement about this plan.
    fn number(&mut self, name: &PlanName) -> Result<i64, Failure> {
        let Some(said) = self.at.publication(name)? else { return Ok(1) };
        let last = self.trusted(name, &said)?.number;
        last.checked_add(1).ok_or_else(|| Failure::error(PublishError::NoNumber { plan: name.to_string() }))
    }

    /// Signs and publishes that this plan holds from now on, as by the command `given`.
    fn state(
        &mut self,
        given: &str,
        name: &PlanName,
        version: &str,
        sha256: &str,
        bundle: Option<&Bundle>,
    ) -> Result<Exit, Failure> {
        let statement = Statement {
            schema: Statement::SCHEMA,
            product: name.product.clone(),
            name: name.plan.clone(),
            version: version.to_owned(),
            sha256: sha256.to_owned(),
            number: self.number(name)?,
            operator: self.why.operator.clone(),
            reason: self.why.reason.to_string(),
            key: self.key.public(),
        };
        let signature = self.key.sign(&statement.text());
        entered_at(&mut self.at, &self.why.operator, given)?;
        if !self.at.publish(&statement, &signature, bundle)? {
            return Err(Failure::error(PublishError::TooLate { plan: name.to_string() }));
        }
        Ok(tell(&format!("{name} {version} holds, as number {}", statement.number)))
    }
}

pub(super) fn list(List { settings, json }: &List) -> Result<Exit, Failure> {
    let address = address(&published(settings)?)?;
    let found = PlantLink::new(address).look(publications)?;
    let found: Vec<_> = found.into_iter().map(|(statement, at_ms)| Holds { statement, at_ms }).collect();
    either(&found, *json, |found| text(found))
}

/// A plan that holds, and since when.
#[derive(Debug, Serialize)]
struct Holds {
    #[serde(flatten)]
    statement: Statement,
    at_ms: i64,
}

fn text(found: &[Holds]) -> String {
    if found.is_empty() {
        return "no plan is published; `halfrow-station plan publish` publishes one".to_owned();
    }
    let row = |Holds { statement, at_ms }: &Holds| {
        let Statement { product, name, version, number, operator, reason, .. } = statement.clone();
        vec![format!("{product}/{name}"), version, number.to_string(), time(*at_ms), operator, reason]
    };
    table(&["plan", "version", "number", "since", "by", "why"], &[2], found.iter().map(row))
}
