//! Arguments with a few possible words or numbers, and times.

use std::time::Duration;

use halfrow::call;
use halfrow::model::{BitDepth, GridShape, ModelPath, Phase, UnavailablePath, UnknownPath, UnknownPhase};
use halfrow::optics::TablesBy;
use pyo3::PyResult;

use crate::errors;

/// Bits of a sample.
pub(crate) fn depth(bits: u32) -> PyResult<BitDepth> {
    let depth = BitDepth::from_bits(bits);
    depth.ok_or_else(|| errors::wrong_value(format!("a sample has no {bits} bits; give 8, 10 or 12")))
}

/// The arrangement of the colours.
pub(crate) fn phase(name: &str) -> PyResult<Phase> {
    name.parse().map_err(errors::input::<UnknownPhase>)
}

/// The named path of the model, or without a name the fastest one on this processor.
pub(crate) fn path(name: Option<&str>) -> PyResult<ModelPath> {
    let Some(name) = name else { return Ok(ModelPath::best()) };
    let path: ModelPath = name.parse().map_err(errors::input::<UnknownPath>)?;
    if path.is_available() { Ok(path) } else { Err(errors::input(UnavailablePath(path))) }
}

/// What is asked of a grid.
pub(crate) struct OfGrid {
    /// The most entries.
    pub(crate) entries: Option<usize>,
    /// Columns from one node to the next.
    pub(crate) nodes_every: Option<usize>,
}

impl OfGrid {
    fn tables_by(&self) -> PyResult<TablesBy> {
        let k = |columns| {
            let wrong = || {
                errors::wrong_value(
                    "a grid has a node every 32 or every 64 columns; give nodes_every one of them",
                )
            };
            GridShape::k_of(columns).ok_or_else(wrong)
        };
        let entries = self.entries.unwrap_or(TablesBy::LEAST_ENTRIES);
        Ok(TablesBy::Exact { entries, k: self.nodes_every.map(k).transpose()? })
    }
}

/// How tables are made: as `rows`, `projection` and `grid` say, or `otherwise` if they leave it open.
pub(crate) fn tables_by(
    rows: Option<&str>,
    projection: &str,
    grid: &OfGrid,
    otherwise: TablesBy,
) -> PyResult<TablesBy> {
    match (projection, rows) {
        ("exact", None) => grid.tables_by(),
        ("exact", Some(_)) => {
            Err(errors::conflict("rows says nothing beside projection=\"exact\"; leave one of them out"))
        }
        ("rows", _) if grid.entries.is_some() => {
            Err(errors::conflict("entries says nothing without projection=\"exact\"; leave it out"))
        }
        ("rows", _) if grid.nodes_every.is_some() => {
            Err(errors::conflict("nodes_every says nothing without projection=\"exact\"; leave it out"))
        }
        ("rows", None) => Ok(otherwise),
        ("rows", Some("fitted")) => Ok(TablesBy::Fitting),
        ("rows", Some("equation-9")) => Ok(TablesBy::Equation9),
        ("rows", Some(other)) => Err(errors::wrong_value(format!(
            "`{other}` is no way to find row factors; give \"fitted\" or \"equation-9\""
        ))),
        (other, _) => {
            Err(errors::wrong_value(format!("`{other}` is no projection; give \"rows\" or \"exact\"")))
        }
    }
}

/// A time in seconds; `what` is its name in the call.
pub(crate) fn seconds(what: &'static str, seconds: Option<f64>) -> PyResult<Option<Duration>> {
    call::seconds(what, seconds).map_err(errors::input)
}

/// The most time in seconds; `what` is its name in the call.
pub(crate) fn time_limit(what: &'static str, seconds: Option<f64>) -> PyResult<Option<Duration>> {
    call::time_limit(what, seconds).map_err(errors::input)
}

/// The time to judge within.
pub(crate) fn within(seconds: Option<f64>) -> PyResult<Option<Duration>> {
    let time = |seconds| {
        let wrong =
            || errors::wrong_value(format!("within is no time to judge within; {}", call::WITHIN_TAKES));
        call::within(seconds).ok_or_else(wrong)
    };
    seconds.map(time).transpose()
}
