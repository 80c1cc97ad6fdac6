//! A history of any length whose true figures are known, since they are counted while it is made.

use std::collections::BTreeMap;

use halfrow_station::history::pareto::{Of, pareto};
use halfrow_station::history::yields::{By, Wanted, Yield, yields};
use halfrow_station::store::{Folder, Snapshot};
use rusqlite::{Connection, Statement, params};

use super::made::{BEGIN_MS, DAY_MS, End, Made, Run, id};

pub(super) const LANES: u64 = 16;
const PARTS: [&str; 5] = ["memory", "row factor", "clock", "samples", "kernel"];
const PLANS: [(&str, &str); 3] = [("final", "6"), ("final", "7"), ("intake", "1")];

/// SplitMix64, by Sebastiano Vigna: the same history every time.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    pub(crate) fn below(&mut self, most: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        (mixed ^ mixed >> 31) % most
    }
}

/// The true figures of the history.
#[derive(Default)]
struct Truth {
    /// For each unit and name of a plan, whether it passed each judgement, in order.
    judged: BTreeMap<(u64, &'static str), Vec<bool>>,
    runs: BTreeMap<&'static str, u64>,
    errors: BTreeMap<&'static str, u64>,
    parts: BTreeMap<&'static str, u64>,
}

/// A history, and its true figures.
pub(crate) struct Generated {
    pub(crate) made: Made,
    truth: Truth,
    pub(crate) runs: u64,
}

pub(crate) fn serial(unit: u64) -> String {
    format!("CAT{unit:07}")
}

/// A history of `runs` runs, in a database as the first program made it, which the station then brings up to date.
pub(crate) fn generate(runs: u64) -> Generated {
    let kept = tempfile::tempdir().unwrap();
    let mut database = Connection::open(Folder::new(kept.path()).database()).unwrap();
    database.execute_batch("PRAGMA synchronous = OFF; PRAGMA cache_size = -400000").unwrap();
    let transaction = database.transaction().unwrap();
    first_schema(&transaction);
    for (place, (name, version)) in PLANS.iter().enumerate() {
        let text = "INSERT INTO plan VALUES ($1, $2, $3, 'CAM-T', '', 0)";
        transaction.execute(text, params![plan_hash(place), name, version]).unwrap();
    }
    let mut to = Statements::of(&transaction);
    let mut draw = Draw(1);
    let mut truth = Truth::default();
    for number in 0..runs {
        to.enter(number, &mut draw, &mut truth);
    }
    drop(to);
    transaction.commit().unwrap();
    drop(database);
    Generated { made: Made::at(kept), truth, runs }
}

/// The tables of the first version.
pub(crate) fn first_schema(to: &Connection) {
    let sqlite = |text: &str| {
        text.replace("{int}", "INTEGER").replace("{real}", "REAL").replace("{strict}", " STRICT")
    };
    let (first, version) =
        (include_str!("../../../sql/schema-1.sql"), include_str!("../../../sql/schema-version.sql"));
    to.execute_batch(&sqlite(version)).unwrap();
    to.execute_batch(&sqlite(first)).unwrap();
    let note = "INSERT INTO schema_version VALUES (1, $1, 0)";
    to.execute(note, [halfrow::result::sha256([first])]).unwrap();
}

fn plan_hash(place: usize) -> String {
    format!("{place:064}")
}

/// The statements that enter runs.
struct Statements<'a> {
    unit: Statement<'a>,
    run: Statement<'a>,
    step: Statement<'a>,
    suspect: Statement<'a>,
}

impl<'a> Statements<'a> {
    fn of(to: &'a Connection) -> Self {
        let prepared = |text| to.prepare(text).unwrap();
        Self {
            unit: prepared("INSERT INTO unit VALUES ($1, 'CAM-T', $2, $3) ON CONFLICT DO NOTHING"),
            run: prepared(
                "INSERT INTO run (id, station, lane, unit_id, plan_sha256, variant, operator_id, target, nth, fence,
                    started_ms, ended_ms, state, verdict, exit_code, cause, headline, record_sha256)
                VALUES ($1, 'station 7', $2, $3, $4, '', $5, 'usb:1-2.3', $6, 1, $7, $8, 'final', $9, 0, $10,
                    'all samples are as the reference has them, in 48 frames and at 3 timings', $11)",
            ),
            step: prepared("INSERT INTO step VALUES ($1, $2, 1, $3, $4, $5, $6, 'as it should be')"),
            suspect: prepared("INSERT INTO suspect VALUES ($1, 1, $2, 'bit 3', 0.9)"),
        }
    }

    /// Units come one after another; one run in thirty is of an earlier unit.
    fn enter(&mut self, number: u64, draw: &mut Draw, truth: &mut Truth) {
        let is_again = number > 100 && draw.below(30) == 0;
        let unit = if is_again { number - 1 - draw.below(100) } else { number };
        let (place, lane) = (draw.below(3) as usize, number % LANES);
        let plan = PLANS[place].0;
        let (verdict, cause, outcome) = match draw.below(100) {
            0..94 => ("PASS", "none", "passed"),
            94..99 => ("FAIL", "board", "failed"),
            _ => ("ERROR", "link", "error"),
        };
        let started_ms = started_ms(number);
        let unit_id = id(BEGIN_MS + unit as i64, 0);
        self.unit.execute(params![unit_id, serial(unit), started_ms]).unwrap();
        let judged = truth.judged.entry((unit, plan)).or_default();
        let nth = 1 + judged.len() as i64;
        if verdict != "ERROR" {
            judged.push(verdict == "PASS");
        }
        *truth.runs.entry(plan).or_default() += 1;
        *truth.errors.entry(plan).or_default() += u64::from(verdict == "ERROR");
        let run = id(started_ms, number as u32);
        let operator = format!("operator {}", number / 500 % 20);
        let (plan, record, ended_ms) = (plan_hash(place), format!("{number:064}"), started_ms + 20_000);
        let lane = lane.to_string();
        let row =
            params![run, lane, unit_id, plan, operator, nth, started_ms, ended_ms, verdict, cause, record];
        self.run.execute(row).unwrap();
        for (seq, name, outcome) in [(1, "identity", "passed"), (2, "verify", outcome)] {
            self.step.execute(params![run, seq, name, outcome, started_ms, ended_ms]).unwrap();
        }
        if verdict == "FAIL" {
            let part = PARTS[draw.below(5).min(draw.below(5)) as usize];
            *truth.parts.entry(part).or_default() += 1;
            self.suspect.execute(params![run, part]).unwrap();
        }
    }
}

/// Each lane begins a run every five minutes.
pub(crate) fn started_ms(number: u64) -> i64 {
    BEGIN_MS + (number / LANES) as i64 * 300_000 + (number % LANES) as i64 * 1000
}

impl Generated {
    pub(crate) fn now(&self) -> Snapshot {
        self.made.now()
    }

    /// Compares everything that is counted with the true figures.
    pub(crate) fn compare(&self) {
        let now = self.now();
        let found = yields(&now, &Wanted::default(), By::Plan).unwrap();
        let mut flips = 0;
        for line in &found.lines {
            let plan = line.plan.plan.as_str();
            let of_plan =
                self.truth.judged.iter().filter(|((_, name), all)| *name == plan && !all.is_empty());
            let units: Vec<_> = of_plan.map(|(_, all)| all).collect();
            let count = |is: &dyn Fn(&Vec<bool>) -> bool| units.iter().filter(|all| is(all)).count() as u64;
            let first = count(&|all| all[0]);
            let last = count(&|all| all[all.len() - 1]);
            let flipped = count(&|all| !all[0] && all[all.len() - 1]);
            assert_eq!((line.first_pass.count, line.first_pass.of), (first, units.len() as u64), "{plan}");
            assert_eq!((line.last.count, line.flipped), (last, flipped), "{plan}");
            assert_eq!((line.errors.count, line.errors.of), (self.truth.errors[plan], self.truth.runs[plan]));
            flips += flipped;
        }
        assert_eq!((found.lines.len(), found.flips.len() as u64), (2, flips));
        assert!(flips > 0);
        let parts = pareto(&now, &Wanted::default(), Of::Part).unwrap();
        let parts: BTreeMap<_, _> =
            parts.bars.iter().map(|bar| (bar.name.as_str(), bar.runs.count)).collect();
        assert_eq!(parts, self.truth.parts);
    }
}

#[test]
fn all_that_is_counted_is_true() {
    generate(6_000).compare();
}

/// What is counted when the database is brought up to date adds up with what is counted at each run.
#[test]
fn what_was_entered_before_and_after_is_counted_together() {
    let mut all = generate(300);
    let count = |all: &Generated| {
        let wanted = Wanted { plan: Some("final".to_owned()), ..Wanted::default() };
        let found = yields(&all.now(), &wanted, By::Plan).unwrap();
        let of = |line: &Yield| (line.first_pass.of, line.first_pass.count, line.last.count, line.flipped);
        let failed = pareto(&all.now(), &wanted, Of::Check).unwrap().failed;
        (found.lines.iter().map(of).collect::<Vec<_>>(), failed)
    };
    let (before, failed) = count(&all);
    let fresh = |serial: &str, end, day| Run { started_ms: BEGIN_MS + day * DAY_MS, ..Run::of(serial, end) };
    for (serial, end, day) in
        [("NEW1", End::Fail(&["clock"]), 50), ("NEW1", End::Pass, 51), ("NEW2", End::Pass, 51)]
    {
        all.made.run(&fresh(serial, end, day));
    }
    let (after, failed_after) = count(&all);
    assert_eq!(failed_after, failed + 1);
    let [(units, first, last, flipped)] = before[..] else { panic!("{before:?}") };
    assert_eq!(after, [(units + 2, first + 1, last + 2, flipped + 1)]);
}
