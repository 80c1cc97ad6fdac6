//! A plan: what is done with every board of a product, and what its results must be.
//!
//! ```text
//!  plan.toml ─► text (TOML, types) ─► read (what they mean together) ─► Plan ─► Selected, for one serial number
//!                                        │
//!                   tables, frames, kernel: every file that the plan names is read, and hashed
//! ```
//!
//! Whatever is wrong with a plan is found when it is loaded, before any board is touched.

pub(crate) mod check_digit;
mod files;
pub mod limits;
pub mod mock;
mod production;
mod read;
pub mod serial;
mod tables;
mod text;

use std::fmt;
use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use halfrow::FrameSource;
use halfrow::optics::Chosen;
use halfrow::result::FileHash;

use crate::input_error::{InputError, text_of};
pub(crate) use files::{changed, plan_hash};
use limits::Limit;
pub use production::{Bad, Production, Shift};
use serial::{Serial, SerialError, SerialRule};

/// The version of the plan's own format.
pub const SCHEMA: u32 = 1;

/// The JSON Schema of a plan, for editors.
pub const JSON_SCHEMA: &str = include_str!("../../schema/plan-1.json");

/// Whether a board must say which device it is, by the FPGA's own number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceRule {
    /// A board without one is refused.
    Required,
    /// A board without one is judged, too.
    IfPresent,
    /// It is not checked.
    NotChecked,
}

/// Whether a unit is tested again whose last judgement under the same plan is PASS.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Again {
    /// It is.
    #[default]
    Allow,
    /// Only when somebody confirms it.
    Ask,
    /// It never is.
    Refuse,
}

/// A plan that can be carried out.
#[derive(Clone, Debug)]
pub struct Plan {
    /// SHA-256 of [`Self::text`] and of every file that it names: whatever was judged by this plan was judged by
    /// exactly this.
    pub sha256: String,
    /// Its text.
    pub text: String,
    /// Its name; with the product it says which runs are compared.
    pub name: String,
    /// Its version.
    pub version: String,
    /// What the boards are.
    pub product: String,
    /// Which serial numbers they have.
    pub serial: SerialRule,
    /// Which of its runs count as production.
    pub production: Production,
    /// The builds of the board that may be judged, as the first eight hexadecimal digits of their commits.
    pub builds: Vec<String>,
    /// Whether a board must say which device it is.
    pub device: DeviceRule,
    /// Whether a unit that passed is tested again.
    pub again: Again,
    /// The files that it names, in order.
    pub files: Vec<FileHash>,
    /// What is done with boards of no named variant.
    base: Selected,
    /// And with those of each variant, by its name.
    variants: Vec<(String, Selected)>,
}

/// A product and the name of its plan, which all versions of that plan have in common.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct PlanName {
    /// The product.
    pub product: String,
    /// The plan's name.
    pub plan: String,
}

impl fmt::Display for PlanName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.product, self.plan)
    }
}

impl From<&Plan> for PlanName {
    fn from(plan: &Plan) -> Self {
        Self { product: plan.product.clone(), plan: plan.name.clone() }
    }
}

/// What is done with one board.
#[derive(Clone, Debug)]
pub struct Selected {
    /// The steps, in order.
    pub steps: Vec<Step>,
    /// The limits.
    pub limits: Vec<Limit>,
}

/// A step of a plan.
#[derive(Clone, Debug)]
pub struct Step {
    /// Its name.
    pub name: String,
    /// What it does.
    pub kind: StepKind,
    /// How often it is tried again when the link or the station was in the way, and nothing speaks against the board.
    pub retries: u32,
    /// The longest that one try may take.
    pub timeout: Duration,
}

/// What a step does.
#[derive(Clone, Debug)]
pub enum StepKind {
    /// Asks the board who it is. Every run begins with it.
    Identity,
    /// Tests the link.
    Link {
        /// How long each part of the test takes.
        each: Duration,
    },
    /// Judges the board.
    Verify(Box<Judging>),
}

impl StepKind {
    /// Its name: stable, lower case.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Identity => "identity",
            Self::Link { .. } => "link",
            Self::Verify(_) => "verify",
        }
    }
}

/// What a board is judged with.
#[derive(Clone, Debug)]
pub struct Judging {
    /// Tables, kernel and lens.
    pub chosen: Chosen,
    /// Bayer phase of built-in frames.
    pub phase: halfrow::model::Phase,
    /// The frames.
    pub frames: Vec<FrameSource>,
    /// How often they are streamed.
    pub repeat: u32,
    /// How long the board then makes frames on its own at the full pixel clock, by its own clock; zero for none. With
    /// `None` it is as long as the judge chooses.
    pub at_speed: Option<Duration>,
    /// The seed of noise, gaps, the link test, the rules, and what the board makes on its own.
    pub seed: Seed,
}

/// Where a seed comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seed {
    /// Drawn from the run's id: different for every run, and recorded with it.
    Run,
    /// Always this one.
    Fixed(u64),
}

impl Plan {
    /// The plan in the file `path`, whose own paths are relative to it.
    ///
    /// # Errors
    /// [`InputError`], with the line.
    pub fn load(path: &Path) -> Result<Self, InputError> {
        if path.to_str().is_none() {
            return Err(InputError::Path { path: path.to_owned() });
        }
        Self::parse(path, text_of(path)?)
    }

    /// The plan `text`, which is or was in the file `path`.
    ///
    /// # Errors
    /// Like [`Self::load`].
    pub fn parse(path: &Path, text: String) -> Result<Self, InputError> {
        read::plan(path, &text).map_err(|fault| fault.in_file(path, &text)).map(|plan| Self { text, ..plan })
    }

    /// What is done with the board of this serial number, which determines its variant.
    ///
    /// # Errors
    /// [`SerialError`] when the number is not one of this product's.
    pub fn select(&self, scanned: &str) -> Result<(Serial, &Selected), SerialError> {
        let serial = self.serial.read(scanned)?;
        let selected = self.variant(&serial.variant);
        Ok((serial, selected))
    }

    /// What is done with boards of this variant.
    #[must_use]
    pub fn variant(&self, name: &str) -> &Selected {
        let named = self.variants.iter().find(|(variant, _)| variant == name);
        named.map_or(&self.base, |(_, selected)| selected)
    }

    /// The named variants, and what is done with all others, under an empty name.
    pub fn variants(&self) -> impl Iterator<Item = (&str, &Selected)> {
        let named = self.variants.iter().map(|(name, selected)| (name.as_str(), selected));
        std::iter::once(("", &self.base)).chain(named)
    }
}
