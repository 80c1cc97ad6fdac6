//! The table of faults and the parts of a run that find them.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use serde::Deserialize;

use crate::frames::Builtin;
use crate::result::CoverageReport;
use crate::run::{AtSpeed, Build, FEW_AT_SPEED, FrameSource, Part, Plan, Selection, Vary};

/// Frames at speed that the faults were measured with.
pub(super) const FRAMES: usize = FEW_AT_SPEED as usize;
/// The widest rows of the board that the faults were put into.
const BOARD_WIDTH: usize = 2048;
/// The table as it was measured.
const TABLE: &str = include_str!("faults.json");
/// All of the table, which is long and so is read once.
static ALL: LazyLock<Result<Faults, FaultsError>> = LazyLock::new(|| Faults::measured(Which::All));

/// A table of faults that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FaultsError {
    /// The table of faults does not have the form that it must have.
    #[error(
        "the table of faults cannot be read, since {what}; make it again with `scripts/hardware coverage`"
    )]
    Form {
        /// What is wrong with it.
        what: String,
    },
    /// The table of faults has an entry that cannot be true.
    #[error(
        "fault {fault} of the table of faults {what}; make the table again with `scripts/hardware coverage`"
    )]
    Fault {
        /// Its place, from 0.
        fault: usize,
        /// What is wrong with it.
        what: String,
    },
}

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    seed: u64,
    width: usize,
    height: usize,
    radius: f64,
    build: String,
    equivalent: usize,
    faults: Vec<Line>,
}

/// A fault that is not proven to make no difference. `frames` has, for each frame that finds it, the frame's number in the whole
/// schedule and its first row that differs.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    block: String,
    frames: Vec<(usize, usize)>,
    at_speed: bool,
    corners: bool,
    rules: bool,
    always: bool,
    whole: bool,
}

/// What is known to find a fault.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Fault {
    /// Any run.
    pub(super) always: bool,
    /// This many rows of a part that is streamed.
    pub(super) rows: Vec<(Part, usize)>,
    /// Frames at speed.
    pub(super) at_speed: bool,
    /// The corners.
    pub(super) corners: bool,
    /// The rules of the wire.
    pub(super) rules: bool,
    /// A whole run.
    pub(super) whole: bool,
}

impl Fault {
    /// Whether a run of `selection` finds it.
    pub(super) fn is_found(&self, selection: &Selection) -> bool {
        self.always
            || self.rows.iter().any(|&(part, rows)| selection.amount(part) >= rows)
            || self.at_speed && selection.amount(Part::AtSpeed) >= FRAMES
            || self.corners && selection.amount(Part::Corners) > 0
            || self.rules && selection.amount(Part::Rules) > 0
    }
}

/// The faults, equal ones grouped.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    /// What they were measured with.
    given: Given,
    /// The build that they were put into.
    build: String,
    /// How many further faults are proven to make no difference.
    equivalent: usize,
    /// How many faults there are of each kind.
    pub(super) groups: BTreeMap<Fault, usize>,
}

/// What a table was measured with.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Given {
    /// Columns.
    width: usize,
    /// Rows.
    height: usize,
    /// The lens's radius, in pixels.
    radius: f64,
    /// The run's seed.
    seed: u64,
}

impl Given {
    /// The usual run with these tables; none if such tables cannot be made.
    fn plan(&self) -> Option<Plan> {
        let Self { width, height, radius, seed } = *self;
        let lens = Equidistant::from_radius(radius).ok()?;
        let geometry = Geometry::centred(width, height, BitDepth::Twelve).ok()?;
        let tables = TableSet::from_lens(geometry, &lens, None).ok()?;
        let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
        Some(Plan { seed, ..plan.varying(Vary { centre: true, depth: true }) })
    }

    /// Whether `plan` has these tables, and the usual kernel, frames and variations.
    fn is_of(&self, plan: &Plan) -> bool {
        let builtin = |source: &FrameSource| match source {
            FrameSource::Builtin(builtin) => Some(*builtin),
            FrameSource::File { .. } => None,
        };
        plan.frames.iter().map(builtin).eq(Builtin::ALL.map(Some))
            && self.plan().is_some_and(|usual| {
                (&plan.tables, &plan.kernel) == (&usual.tables, &usual.kernel)
                    && (plan.lens, plan.centre_y, plan.phase) == (usual.lens, usual.centre_y, usual.phase)
                    && (plan.vary, plan.repeat, plan.seed) == (usual.vary, usual.repeat, usual.seed)
            })
    }

    /// The part that each frame belongs to, by frame number, on a board that has all capabilities.
    fn parts(&self) -> BTreeMap<usize, Part> {
        let schedule = self.plan().map(|plan| plan.schedule(&Build::full(BOARD_WIDTH)));
        let frames = schedule.into_iter().flatten().flat_map(|segment| segment.frames);
        frames.map(|frame| (frame.number.into(), frame.part)).collect()
    }
}

/// Which faults of a table to take, by their place from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// All of them.
    All,
    /// Those at even places.
    Even,
    /// Those at odd places.
    Odd,
}

impl Faults {
    /// All faults that were measured.
    ///
    /// # Errors
    /// [`FaultsError`] when their table cannot be used.
    pub fn all() -> Result<&'static Self, FaultsError> {
        ALL.as_ref().map_err(Clone::clone)
    }

    /// The chosen part of the faults that were measured.
    ///
    /// # Errors
    /// [`FaultsError`] when their table cannot be used.
    pub fn measured(which: Which) -> Result<Self, FaultsError> {
        Self::read(TABLE, which)
    }

    /// # Errors
    /// [`FaultsError`], which names what is wrong.
    fn read(text: &str, which: Which) -> Result<Self, FaultsError> {
        let Table { seed, width, height, radius, build, equivalent, faults } =
            serde_json::from_str(text).map_err(|error| FaultsError::Form { what: error.to_string() })?;
        let given = Given { width, height, radius, seed };
        let (parts, mut groups) = (given.parts(), BTreeMap::new());
        for (place, line) in faults.iter().enumerate() {
            let fault =
                line.fault(height, &parts).map_err(|what| FaultsError::Fault { fault: place, what })?;
            let is_taken = match which {
                Which::All => true,
                Which::Even => place % 2 == 0,
                Which::Odd => place % 2 == 1,
            };
            if is_taken {
                *groups.entry(fault).or_default() += 1;
            }
        }
        Ok(Self { given, build, equivalent, groups })
    }

    /// Whether they were measured with what `plan` streams, on a board of this build.
    #[must_use]
    pub(crate) fn are_of(&self, plan: &Plan, build: &str) -> bool {
        self.build == build && self.given.is_of(plan)
    }

    /// What a whole run by `plan` finds on a board of this build; none if that was not measured.
    #[must_use]
    pub fn whole(&self, plan: &Plan, build: &str) -> Option<CoverageReport> {
        let is_whole = plan.selection.is_none() && plan.within.is_none() && plan.at_speed == AtSpeed::Usual;
        (is_whole && self.are_of(plan, build)).then(|| CoverageReport {
            found: self.found_by_whole(),
            faults: self.count(),
            equivalent: self.equivalent,
        })
    }

    /// The columns and rows that they were measured with.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.given.width, self.given.height)
    }

    /// How many faults there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.groups.values().sum()
    }

    /// How many of them a whole run finds, including those that no single part is known to find.
    #[must_use]
    pub(crate) fn found_by_whole(&self) -> usize {
        self.groups.iter().filter(|(fault, _)| fault.whole).map(|(_, count)| count).sum()
    }

    /// How many of them a run of `selection` is known to find.
    #[must_use]
    pub fn found(&self, selection: &Selection) -> usize {
        self.groups.iter().filter(|(fault, _)| fault.is_found(selection)).map(|(_, count)| count).sum()
    }

    /// The same for frames of `height` rows, in proportion: faults that the first tenth of the rows finds in the measured frames
    /// count as found by the first tenth here.
    #[must_use]
    pub fn scaled(&self, height: usize) -> Self {
        let of = |rows: usize| (rows * height).div_ceil(self.given.height.max(1)).clamp(1, height.max(1));
        let mut groups = BTreeMap::new();
        for (fault, count) in &self.groups {
            let rows = fault.rows.iter().map(|&(part, rows)| (part, of(rows))).collect();
            *groups.entry(Fault { rows, ..fault.clone() }).or_default() += count;
        }
        Self { groups, ..self.clone() }
    }
}

impl Line {
    /// What finds it, or what is wrong with the line. `height` is the rows of a frame, `parts` the part of each frame.
    fn fault(&self, height: usize, parts: &BTreeMap<usize, Part>) -> Result<Fault, String> {
        let Self { block, frames, at_speed, corners, rules, always, whole } = self;
        if block.is_empty() {
            return Err("names no block".to_owned());
        }
        let mut rows = BTreeMap::new();
        for &(number, row) in frames {
            let part =
                *parts.get(&number).ok_or_else(|| format!("names frame {number}, which no run has"))?;
            if row >= height {
                return Err(format!("names row {row} of {height}"));
            }
            if rows.insert(part, row + 1).is_some() {
                return Err(format!("names frame {number} twice"));
            }
        }
        if !whole && (*always || *at_speed || *corners || *rules || !rows.is_empty()) {
            return Err("is found by a part and not by the whole".to_owned());
        }
        let rows = rows.into_iter().collect();
        Ok(Fault {
            always: *always,
            rows,
            at_speed: *at_speed,
            corners: *corners,
            rules: *rules,
            whole: *whole,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use halfrow_model::Phase;

    use super::*;

    const HEAD: &str = r#"{"seed": 1, "width": 64, "height": 16, "radius": 40.0, "build": "0a0b0c0d", "equivalent": 7, "faults": ["#;
    const FOUND: &str =
        r#""at_speed": false, "corners": false, "rules": false, "always": false, "whole": true}"#;

    fn read(line: &str) -> Result<Faults, FaultsError> {
        Faults::read(&format!("{HEAD}{line}]}}"), Which::All)
    }

    #[test]
    fn the_table_in_the_repository_can_be_read_in_whole_and_in_halves() {
        let [all, even, odd] =
            [Which::All, Which::Even, Which::Odd].map(|which| Faults::measured(which).unwrap());
        assert_eq!(all.count(), even.count() + odd.count());
        assert!(even.count() - odd.count() < 2 && all.groups.len() < all.count());
        let parts = [Part::Decoy, Part::Swap, Part::Gaps, Part::AtSpeed, Part::Corners];
        assert!(all.found(&Selection::all(parts)) > all.found(&Selection::least()));
    }

    #[test]
    fn what_is_wrong_with_a_table_is_named() {
        let line =
            |block: &str, frames: &str| format!(r#"{{"block": "{block}", "frames": {frames}, {FOUND}"#);
        let wrong = |text: &str| read(text).unwrap_err().to_string();
        assert!(
            wrong(&line("core", "[[19, 0]]"))
                .contains("fault 0 of the table of faults names frame 19, which no run has")
        );
        assert!(wrong(&line("core", "[[0, 16]]")).contains("names row 16 of 16"));
        assert!(wrong(&line("core", "[[3, 1], [3, 2]]")).contains("names frame 3 twice"));
        assert!(wrong(&line("", "[]")).contains("names no block"));
        assert!(wrong(r#"{"block": "core"}"#).contains("missing field"));
        assert!(wrong(&line("core", "[]").replace("always", "ever")).contains("unknown field `ever`"));
    }

    #[test]
    fn what_a_whole_run_finds_is_told_of_the_measured_plan_on_the_measured_build_alone() {
        let line = |found: &str| format!(r#"{{"block": "core", "frames": [], {found}"#);
        let unfound = FOUND.replace(r#""whole": true"#, r#""whole": false"#);
        let faults = read(&[line(FOUND), line(FOUND), line(&unfound)].join(",")).unwrap();
        let lens = Equidistant::from_radius(40.0).unwrap();
        let geometry = Geometry::centred(64, 16, BitDepth::Twelve).unwrap();
        let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
        let plan = Plan::new(tables, Interpolant::Hermite.into()).seen_through(lens);
        let plan = plan.varying(Vary { centre: true, depth: true });
        let told = Some(CoverageReport { found: 2, faults: 3, equivalent: 7 });
        assert_eq!(faults.whole(&plan, "0a0b0c0d"), told);
        assert_eq!(faults.whole(&plan, "00000000"), None);
        let others = [
            Plan { seed: 2, ..plan.clone() },
            Plan { at_speed: AtSpeed::Off, ..plan.clone() },
            Plan { within: Some(Duration::from_secs(1)), ..plan.clone() },
            Plan { selection: Some(Selection::least()), ..plan.clone() },
            Plan { kernel: Interpolant::Linear.into(), ..plan.clone() },
            Plan { vary: Vary::default(), ..plan.clone() },
            Plan { phase: Phase::Rggb, ..plan.clone() },
        ];
        assert!(others.iter().all(|other| faults.whole(other, "0a0b0c0d").is_none()));
    }

    #[test]
    fn alike_faults_are_one_group_and_rows_are_taken_in_proportion() {
        let line = |frames: &str| format!(r#"{{"block": "core", "frames": {frames}, {FOUND}"#);
        let faults =
            read(&[line("[[0, 3]]"), line("[[0, 3]]"), line("[[1, 0], [2, 15]]"), line("[]")].join(","))
                .unwrap();
        assert_eq!((faults.count(), faults.groups.len()), (4, 3));
        let least = Selection::least();
        let found = |selection: &Selection| faults.found(selection);
        assert_eq!(
            [found(&least), found(&least.with(Part::Decoy, 3)), found(&least.with(Part::Decoy, 4))],
            [0, 0, 2]
        );
        assert_eq!(
            [found(&least.with(Part::Judged(0), 15)), found(&least.with(Part::Judged(0), 16))],
            [0, 1]
        );
        // 4 of 16 rows are 270 of 1080, and 1 is 68.
        let scaled = faults.scaled(1080);
        let found = |part, rows| scaled.found(&least.with(part, rows));
        assert_eq!([found(Part::Decoy, 269), found(Part::Decoy, 270)], [0, 2]);
        assert_eq!([found(Part::Swap, 67), found(Part::Swap, 68)], [0, 1]);
    }
}
