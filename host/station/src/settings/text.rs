//! The settings as they stand in their file. A value that an error may name has its place with it.

use serde::Deserialize;
use toml::Spanned;

use crate::export::Format;

/// The whole file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SettingsText {
    pub(super) schema: Spanned<u32>,
    pub(super) station: StationText,
    #[serde(default)]
    pub(super) scanner: ScannerText,
    #[serde(default)]
    pub(super) web: WebText,
    pub(super) access: Option<AccessText>,
    pub(super) plant: Option<PlantText>,
    pub(super) work: Option<WorkText>,
    #[serde(default)]
    pub(super) sink: Vec<SinkText>,
    #[serde(default)]
    pub(super) labgrid: LabgridText,
    #[serde(default)]
    pub(super) lane: Vec<LaneText>,
    #[serde(default, rename = "on-pass")]
    pub(super) on_pass: Vec<HookText>,
    #[serde(default, rename = "on-fail")]
    pub(super) on_fail: Vec<HookText>,
    #[serde(default, rename = "on-error")]
    pub(super) on_error: Vec<HookText>,
    #[serde(default, rename = "on-clear")]
    pub(super) on_clear: Vec<HookText>,
}

/// `[station]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StationText {
    pub(super) name: Spanned<String>,
    pub(super) data: Spanned<String>,
    #[serde(default)]
    pub(super) order: OrderText,
    pub(super) silence: Option<Spanned<f64>>,
    pub(super) memory: Option<Spanned<u64>>,
}

/// Which lane a scan is for when there are several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum OrderText {
    #[default]
    LaneFirst,
    ScanThenPlug,
}

/// `[scanner]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScannerText {
    #[serde(default)]
    pub(super) prefix: String,
    #[serde(default)]
    pub(super) suffix: String,
}

/// `[web]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WebText {
    pub(super) listen: Option<Spanned<String>>,
    pub(super) public: Option<Spanned<String>>,
    pub(super) hosts: Option<Spanned<Vec<String>>>,
}

/// `[access]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AccessText {
    pub(super) users: Spanned<String>,
    pub(super) tokens: Option<Spanned<String>>,
    pub(super) hours: Option<Spanned<f64>>,
}

/// `[plant]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlantText {
    pub(super) url: Spanned<String>,
    pub(super) password_file: Option<Spanned<String>>,
    pub(super) ca: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) green: GreenText,
    pub(super) most_unsent: Option<Spanned<u32>>,
    pub(super) most_filled: Option<Spanned<u8>>,
    #[serde(default)]
    pub(super) trusts: Vec<Spanned<String>>,
}

/// `[labgrid]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LabgridText {
    pub(super) coordinator: Option<Spanned<String>>,
    pub(super) program: Option<Spanned<String>>,
    pub(super) deadline: Option<Spanned<f64>>,
}

/// Who must have a result before its verdict is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum GreenText {
    #[default]
    Station,
    Plant,
}

/// `[work]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorkText {
    pub(super) plans: Spanned<Vec<Spanned<String>>>,
    #[serde(default)]
    pub(super) has: Vec<Spanned<String>>,
    pub(super) at_once: Option<Spanned<u32>>,
}

/// A `[[sink]]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SinkText {
    pub(super) name: Spanned<String>,
    pub(super) folder: Option<Spanned<String>>,
    pub(super) post: Option<Spanned<String>>,
    pub(super) mqtt: Option<Spanned<String>>,
    pub(super) format: Option<Spanned<Format>>,
    pub(super) token_file: Option<Spanned<String>>,
    pub(super) user: Option<Spanned<String>>,
    pub(super) password_file: Option<Spanned<String>>,
    pub(super) ca: Option<Spanned<String>>,
    pub(super) proxy: Option<Spanned<String>>,
}

/// A `[[lane]]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LaneText {
    pub(super) name: Spanned<String>,
    pub(super) board: Spanned<String>,
    pub(super) plans: Spanned<Vec<Spanned<String>>>,
    pub(super) start: Option<Spanned<Vec<StartText>>>,
}

/// What starts a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StartText {
    Scan,
    Button,
    Presence,
}

/// An `[[on-…]]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HookText {
    pub(super) program: Spanned<String>,
    #[serde(default)]
    pub(super) arguments: Vec<Spanned<String>>,
    pub(super) deadline: Option<Spanned<f64>>,
}
