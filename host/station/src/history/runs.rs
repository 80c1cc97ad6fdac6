//! Pages of runs.

use std::fmt;
use std::str::FromStr;

use halfrow::Verdict;
use serde::{Serialize, Serializer};

use super::{Period, plans_asked};
use crate::store::{DatabaseError, Found, Snapshot, StoreError, Value, statements, values};

/// The most runs on a page.
pub const MOST: u32 = 1000;

/// Which runs are wanted; all of them by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// Of the units of this serial number.
    pub serial: Option<String>,
    /// Of this verdict.
    pub verdict: Option<Verdict>,
    /// Of this product.
    pub product: Option<String>,
    /// Under plans of this name.
    pub plan: Option<String>,
    /// At this station.
    pub station: Option<String>,
    /// In this lane.
    pub lane: Option<String>,
    /// By this operator.
    pub operator: Option<String>,
    /// That began in this period.
    pub period: Period,
}

/// The place of a run among all runs, after which a page can begin.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cursor {
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
    /// Its id.
    pub id: String,
}

impl fmt::Display for Cursor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.started_ms, self.id)
    }
}

impl Serialize for Cursor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A text that is not a cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this is no place among the runs; take the one that the page before ends with")]
pub struct NoCursor;

impl FromStr for Cursor {
    type Err = NoCursor;

    fn from_str(text: &str) -> Result<Self, NoCursor> {
        let (started, id) = text.split_once('.').ok_or(NoCursor)?;
        let started_ms = started.parse().map_err(|_| NoCursor)?;
        uuid::Uuid::try_parse(id).map_err(|_| NoCursor)?;
        Ok(Self { started_ms, id: id.to_owned() })
    }
}

/// A run in one line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RunLine {
    /// The run.
    pub id: String,
    /// When it began, in milliseconds since 1970, UTC.
    pub started_ms: i64,
    /// When it ended; `None` while it is open, like everything else that its end decides.
    pub ended_ms: Option<i64>,
    /// The product.
    pub product: String,
    /// The serial number.
    pub serial: String,
    /// The plan's name.
    pub plan: String,
    /// The plan's version.
    pub version: String,
    /// The station.
    pub station: String,
    /// The lane.
    pub lane: String,
    /// Who started it.
    pub operator: String,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Who or what is the cause of it.
    pub cause: Option<String>,
    /// The result in one sentence.
    pub headline: Option<String>,
    /// Which judgement of the unit under plans of this name it is, counted from 1; an ERROR has the number of the next one.
    /// 0 of what checks a shift, and of a run whose job was cancelled or claimed again.
    pub nth: i64,
    /// Whether there is a waiver.
    pub waived: bool,
    /// The hash of the record.
    pub record_sha256: Option<String>,
    /// `mock`, `sim`, `replay` or `hardware`; `None` also if the board did not say what it is.
    pub board_kind: Option<String>,
    /// The exit code.
    pub exit_code: Option<u8>,
}

impl RunLine {
    /// From the first eighteen columns.
    pub(super) fn of(row: &Found<'_>) -> Result<Self, DatabaseError> {
        Ok(Self {
            id: row.get(0)?,
            started_ms: row.get(1)?,
            ended_ms: row.get(2)?,
            product: row.get(3)?,
            serial: row.get(4)?,
            plan: row.get(5)?,
            version: row.get(6)?,
            station: row.get(7)?,
            lane: row.get(8)?,
            operator: row.get(9)?,
            verdict: row.get(10)?,
            cause: row.get(11)?,
            headline: row.get(12)?,
            nth: row.get(13)?,
            waived: row.get(14)?,
            record_sha256: row.get(15)?,
            board_kind: row.get(16)?,
            exit_code: row.get(17)?,
        })
    }

    /// Whether it is a judgement that counts.
    pub(crate) fn is_judgement(&self) -> bool {
        self.nth > 0 && matches!(self.verdict, Some(Verdict::Pass | Verdict::Fail))
    }

    /// Whether it is over and counts nowhere.
    pub(crate) fn is_uncounted(&self) -> bool {
        self.nth == 0 && self.verdict.is_some()
    }

    fn cursor(&self) -> Cursor {
        Cursor { started_ms: self.started_ms, id: self.id.clone() }
    }
}

/// A page of runs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Page {
    /// The runs, the newest first.
    pub runs: Vec<RunLine>,
    /// The cursor after which the next page begins; `None` on the last page.
    pub next: Option<Cursor>,
}

/// At most `limit` runs, 1 to [`MOST`], that pass `filter`, beginning with the one after `after`.
///
/// # Errors
/// [`StoreError`] when the database cannot be read.
pub fn page(of: &Snapshot, filter: &Filter, after: Option<&Cursor>, limit: u32) -> Result<Page, StoreError> {
    let limit = limit.clamp(1, MOST);
    let verdict = filter.verdict.map(|verdict| verdict.to_string());
    let units = filter.serial.as_deref().map(|serial| units(of, serial)).transpose()?;
    let plans = keys(plans_asked(of, filter.product.as_deref(), filter.plan.as_deref())?);
    let mut runs = Vec::new();
    for unit in keys(units) {
        for plan in &plans {
            let equal = [
                ("unit_id", unit.as_ref()),
                ("operator_id", filter.operator.as_ref()),
                ("station", filter.station.as_ref()),
                ("lane", filter.lane.as_ref()),
                ("plan_sha256", plan.as_ref()),
                ("verdict", verdict.as_ref()),
            ];
            runs.append(&mut one(of, &equal, filter.period, after, limit + 1)?);
        }
    }
    runs.sort_unstable_by_key(|run| std::cmp::Reverse(run.cursor()));
    let has_more = runs.len() > limit as usize;
    runs.truncate(limit as usize);
    let next = runs.last().filter(|_| has_more).map(RunLine::cursor);
    Ok(Page { runs, next })
}

/// The keys that are asked for, each by itself; a single `None` when none is.
fn keys(asked: Option<Vec<String>>) -> Vec<Option<String>> {
    asked.map_or_else(|| vec![None], |keys| keys.into_iter().map(Some).collect())
}

fn units(of: &Snapshot, serial: &str) -> Result<Vec<String>, StoreError> {
    of.rows("to tell a unit", statements::UNITS_OF_SERIAL, values![serial], |row| row.get(0))
}

/// The first runs in which these columns have these values.
fn one(
    of: &Snapshot,
    equal: &[(&str, Option<&String>)],
    period: Period,
    after: Option<&Cursor>,
    limit: u32,
) -> Result<Vec<RunLine>, StoreError> {
    let columns: Vec<_> = equal.iter().filter(|(_, value)| value.is_some()).map(|(name, _)| *name).collect();
    let text = text(&columns, period, after.is_some(), limit);
    let mut values: Vec<Value<'_>> = Vec::new();
    values.extend(equal.iter().filter_map(|(_, value)| *value).map(Value::from));
    if period != Period::default() {
        values.extend([period.from_ms, period.until_ms].map(Value::from));
    }
    if let Some(Cursor { started_ms, id }) = after {
        values.extend([Value::from(*started_ms), id.into()]);
    }
    of.rows("to tell its runs", &text, &values, RunLine::of)
}

/// The statement for conditions on these columns, the most selective first. Only that one may choose the index:
/// between two about which it knows nothing, an engine may choose the one that holds for nearly all runs.
fn text(equal: &[&str], period: Period, is_next: bool, limit: u32) -> String {
    let mut used = 0;
    let mut parameter = || {
        used += 1;
        format!("${used}")
    };
    let mut conditions: Vec<String> = Vec::new();
    for (place, column) in equal.iter().enumerate() {
        let column = if place == 0 { format!("run.{column}") } else { format!("coalesce(run.{column}, '')") };
        conditions.push(format!("{column} = {}", parameter()));
    }
    if period != Period::default() {
        let (from, until) = (parameter(), parameter());
        conditions.push(format!("run.started_ms >= {from} AND run.started_ms < {until}"));
    }
    if is_next {
        let (started, id) = (parameter(), parameter());
        conditions.push(format!("(run.started_ms, run.id) < ({started}, {id})"));
    }
    let all = conditions.join(" AND ");
    let filters = if all.is_empty() { all } else { format!("WHERE {all}") };
    statements::RUNS.replace("{filters}", &filters).replace("{limit}", &limit.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{Folder, Store};

    /// How SQLite executes a statement.
    fn explained(of: &Snapshot, text: &str, parameters: usize) -> Vec<String> {
        let values = vec![Value::Whole(1); parameters];
        of.rows("a plan", &format!("EXPLAIN QUERY PLAN {text}"), &values, |row| row.get(3)).unwrap()
    }

    #[test]
    fn every_page_comes_from_an_index_in_its_order_whatever_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let folder = Folder::new(folder.path());
        drop(Store::open(&folder).unwrap());
        let of = Snapshot::take(&folder).unwrap();
        let all = ["unit_id", "operator_id", "station", "lane", "plan_sha256", "verdict"];
        let index = ["run_unit", "run_operator", "run_station", "run_lane", "run_plan", "run_verdict"];
        let some = Period { from_ms: 1, until_ms: 2 };
        for chosen in 0_usize..1 << all.len() {
            let is_chosen = |place: &usize| chosen >> place & 1 == 1;
            let columns: Vec<_> = (0..all.len()).filter(is_chosen).map(|place| all[place]).collect();
            for (period, is_next) in
                [(Period::default(), false), (some, false), (Period::default(), true), (some, true)]
            {
                let parameters = columns.len() + 2 * usize::from(period == some) + 2 * usize::from(is_next);
                let text = text(&columns, period, is_next, 51);
                let how = explained(&of, &text, parameters);
                assert!(!how.iter().any(|step| step.contains("TEMP B-TREE")), "{text}\n{how:?}");
                let index = (0..all.len()).find(is_chosen).map_or("run_time", |place| index[place]);
                assert!(how[0].contains(&format!("INDEX {index}")), "{text}\n{how:?}");
            }
        }
    }

    #[test]
    fn a_cursor_reads_back_and_nothing_else_is_one() {
        let cursor = Cursor { started_ms: 7, id: "017f22e2-79b0-7cc3-98c4-dc0c0c07398f".to_owned() };
        assert_eq!(cursor.to_string().parse(), Ok(cursor));
        for wrong in ["", "7", "7.", ".017f22e2-79b0-7cc3-98c4-dc0c0c07398f", "7.x' OR 1=1"] {
            assert_eq!(wrong.parse::<Cursor>(), Err(NoCursor), "{wrong}");
        }
    }
}
