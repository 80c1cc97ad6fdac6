//! A plan as it is in its file: what TOML and its types can say, each value with its place where an error may name it.

use std::collections::BTreeMap;

use halfrow::model::Phase;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer, de};
use toml::Spanned;

use super::check_digit::CheckDigit;
use super::limits::Blame;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlanText {
    pub(super) schema: Spanned<u32>,
    pub(super) plan: AboutText,
    pub(super) serial: SerialText,
    pub(super) board: BoardText,
    pub(super) shift: Option<ShiftText>,
    #[serde(default)]
    pub(super) tables: TablesText,
    #[serde(default)]
    pub(super) step: Vec<StepText>,
    #[serde(default)]
    pub(super) limits: LimitsText,
    #[serde(default)]
    pub(super) variant: BTreeMap<Spanned<String>, VariantText>,
}

/// `[plan]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AboutText {
    pub(super) name: Spanned<String>,
    pub(super) version: Spanned<String>,
    pub(super) product: Spanned<String>,
}

/// `[serial]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SerialText {
    pub(super) pattern: Spanned<String>,
    pub(super) check: CheckDigit,
}

/// `[board]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoardText {
    pub(super) require_hardware: bool,
    pub(super) builds: Spanned<Vec<Spanned<String>>>,
    pub(super) device: super::DeviceRule,
    #[serde(default)]
    pub(super) again: super::Again,
}

/// `[shift]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShiftText {
    pub(super) good: Spanned<String>,
    pub(super) bad: Spanned<String>,
    pub(super) hours: Spanned<f64>,
}

/// `[tables]`, and what a step or a variant says instead.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TablesText {
    pub(super) lens: Option<Spanned<String>>,
    pub(super) file: Option<Spanned<String>>,
    pub(super) radius: Option<Spanned<f64>>,
    pub(super) width: Option<Spanned<usize>>,
    pub(super) height: Option<Spanned<usize>>,
    pub(super) bits: Option<Spanned<u32>>,
    #[serde(default, deserialize_with = "phase")]
    pub(super) phase: Option<Phase>,
    pub(super) rows: Option<RowsText>,
    pub(super) kernel: Option<Spanned<String>>,
    /// Where it says what replaces the plan's own, if it does.
    #[serde(skip)]
    pub(super) instead: Option<usize>,
}

/// How row factors are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum RowsText {
    Fitted,
    #[serde(rename = "equation-9")]
    Equation9,
}

/// A `[[step]]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StepText {
    pub(super) kind: Spanned<StepKindText>,
    pub(super) name: Option<Spanned<String>>,
    pub(super) seconds: Option<Spanned<f64>>,
    pub(super) retries: Option<Spanned<u32>>,
    pub(super) timeout: Option<Spanned<f64>>,
    pub(super) frames: Option<Spanned<Vec<Spanned<String>>>>,
    pub(super) repeat: Option<Spanned<u32>>,
    pub(super) at_speed: Option<Spanned<f64>>,
    pub(super) seed: Option<Spanned<SeedText>>,
    pub(super) tables: Option<TablesText>,
}

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StepKindText {
    Link,
    Verify,
}

/// `"run"`, or a number.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub(super) enum SeedText {
    Number(u64),
    Word(String),
    Other(IgnoredAny),
}

/// `[limits]`, by the measurement's name.
pub(super) type LimitsText = BTreeMap<Spanned<String>, LimitText>;

/// A limit on a measurement.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitText {
    pub(super) least: Option<Spanned<f64>>,
    pub(super) most: Option<Spanned<f64>>,
    pub(super) unit: Option<Spanned<String>>,
    pub(super) blames: Option<Blame>,
}

/// `[variant.NAME]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VariantText {
    #[serde(default)]
    pub(super) tables: TablesText,
    #[serde(default)]
    pub(super) limits: LimitsText,
}

fn phase<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Phase>, D::Error> {
    let name = String::deserialize(deserializer)?;
    name.parse().map(Some).map_err(de::Error::custom)
}
