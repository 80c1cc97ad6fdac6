//! What the commands that show results have in common.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use comfy_table::{CellAlignment, Table, presets};
use halfrow::Verdict;
use halfrow::words::plain;
use jiff::Timestamp;
use serde::Serialize;

use super::beginning::{load_without_lanes, plant};
use super::{Failure, print};
use crate::exit::Exit;
use crate::history::runs::Filter;
use crate::history::yields::Wanted;
use crate::history::{Period, moment};
use crate::store::{Folder, Plant, Snapshot};

/// Where the station's results are.
#[derive(Debug, Args)]
pub(super) struct Data {
    /// The station's folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
}

impl Data {
    /// The folder.
    pub(super) fn folder(&self) -> Folder {
        Folder::new(&self.data)
    }
}

/// Whose results are looked at.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub(super) struct Results {
    /// The station's folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: Option<PathBuf>,
    /// The results of all stations instead, from the plant of these settings
    #[arg(long, value_name = "SETTINGS")]
    plant: Option<PathBuf>,
}

impl Results {
    /// Whether they are of several stations.
    pub(super) const fn is_of_plant(&self) -> bool {
        self.plant.is_some()
    }

    /// The results as they are now.
    pub(super) fn snapshot(&self) -> Result<Snapshot, Failure> {
        if let Some(path) = &self.plant {
            let address = plant(&load_without_lanes(path)?)?.address()?.patient();
            return Ok(Snapshot::of_plant(Plant::connect(&address)?)?);
        }
        let data = self.data.as_deref().unwrap_or(Path::new("."));
        Ok(Snapshot::take(&Folder::new(data))?)
    }
}

/// A range in which there is no moment.
#[derive(Debug, thiserror::Error)]
#[error("--until is not after --from, so no run can be meant; give the earlier one with --from")]
pub(super) struct NoRange;

/// Which runs are meant, by when they began.
#[derive(Clone, Copy, Debug, Args)]
struct Range {
    /// Runs that began at this moment or later: 2026-11-22, which begins at midnight UTC, or 2026-11-22T06:00:00+01:00
    #[arg(long, value_name = "TIME", value_parser = from)]
    from: Option<i64>,
    /// Runs that began before this moment, or no later than on this day
    #[arg(long, value_name = "TIME", value_parser = until)]
    until: Option<i64>,
}

impl Range {
    /// The range as a period.
    fn period(self) -> Result<Period, Failure> {
        let all = Period::default();
        let (from_ms, until_ms) = (self.from.unwrap_or(all.from_ms), self.until.unwrap_or(all.until_ms));
        if from_ms < until_ms { Ok(Period { from_ms, until_ms }) } else { Err(Failure::call(NoRange)) }
    }
}

/// Which units are counted.
#[derive(Debug, Args)]
pub(super) struct Counted {
    /// Only of this product
    #[arg(long, value_name = "NAME")]
    product: Option<String>,
    /// Only under plans of this name
    #[arg(long, value_name = "NAME")]
    plan: Option<String>,
    /// Only at this station of a plant
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
    /// Only in this lane
    #[arg(long)]
    lane: Option<String>,
    #[command(flatten)]
    range: Range,
}

impl Counted {
    /// In the form that the counting functions take.
    pub(super) fn wanted(&self) -> Result<Wanted, Failure> {
        let Self { product, plan, station, lane, range } = self;
        Ok(Wanted {
            product: product.clone(),
            plan: plan.clone(),
            station: station.clone(),
            lane: lane.clone(),
            period: range.period()?,
        })
    }
}

/// Which runs are meant, by what they say of themselves.
#[derive(Debug, Args)]
struct RunChoice {
    /// Only units of this serial number
    #[arg(long)]
    serial: Option<String>,
    /// Only this verdict
    #[arg(long, value_enum, ignore_case = true)]
    verdict: Option<Word>,
    /// Only of this product
    #[arg(long, value_name = "NAME")]
    product: Option<String>,
    /// Only under plans of this name
    #[arg(long, value_name = "NAME")]
    plan: Option<String>,
    /// Only at this station of a plant
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
    /// Only in this lane
    #[arg(long)]
    lane: Option<String>,
    /// Only by this operator
    #[arg(long, value_name = "NAME")]
    operator: Option<String>,
}

/// Which runs are meant.
#[derive(Debug, Args)]
pub(super) struct Filtered {
    #[command(flatten)]
    said: RunChoice,
    #[command(flatten)]
    range: Range,
}

impl Filtered {
    /// The groups of its arguments, for arguments that conflict with all of them: Clap's group of a structure does not
    /// include what is flattened into it.
    pub(super) const GROUPS: [&str; 2] = ["RunChoice", "Range"];

    /// As a filter.
    pub(super) fn filter(&self) -> Result<Filter, Failure> {
        let RunChoice { serial, verdict, product, plan, station, lane, operator } = &self.said;
        Ok(Filter {
            serial: serial.clone(),
            verdict: verdict.map(Into::into),
            product: product.clone(),
            plan: plan.clone(),
            station: station.clone(),
            lane: lane.clone(),
            operator: operator.clone(),
            period: self.range.period()?,
        })
    }
}

/// A verdict, as it is written on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Word {
    /// The board is right.
    Pass,
    /// The board is wrong.
    Fail,
    /// It could not be judged.
    Error,
}

impl From<Word> for Verdict {
    fn from(word: Word) -> Self {
        match word {
            Word::Pass => Self::Pass,
            Word::Fail => Self::Fail,
            Word::Error => Self::Error,
        }
    }
}

/// The first moment of `text`, in milliseconds since 1970.
fn from(text: &str) -> Result<i64, String> {
    given(text, 0)
}

/// The first moment after `text`, where a date means the whole day.
fn until(text: &str) -> Result<i64, String> {
    given(text, 1)
}

fn given(text: &str, days: i64) -> Result<i64, String> {
    let wrong =
        || "give a date from 1970 to 9999, as 2026-11-22, or a moment, as 2026-11-22T06:00:00Z".to_owned();
    moment(text, days).ok_or_else(wrong)
}

/// A moment for people: UTC, to the second.
pub(super) fn time(ms: i64) -> String {
    let moment = Timestamp::from_millisecond(ms).ok();
    moment.map_or_else(|| ms.to_string(), |moment| format!("{moment:.0}"))
}

/// Prints a result as JSON, or in the words of `text`.
pub(super) fn either<T: Serialize>(
    result: &T,
    is_json: bool,
    text: impl FnOnce(&T) -> String,
) -> Result<Exit, Failure> {
    if is_json {
        return print(&serde_json::to_string_pretty(result).map_err(Failure::error)?);
    }
    print(&text(result))
}

/// A table for people, with the columns `numbers` aligned right. Control characters, which a board or a scanner may
/// have said, are escaped.
pub(super) fn table(
    header: &[&str],
    numbers: &[usize],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(header.iter().copied());
    for row in rows {
        table.add_row(row.iter().map(|cell| plain(cell).into_owned()));
    }
    for column in table.column_iter_mut().filter(|column| numbers.contains(&column.index)) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}
