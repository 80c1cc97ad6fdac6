//! A history of any length whose truth is known, since it is counted while it is made.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use halfrow::Verdict;
use halfrow_station::history::pareto::{Of, pareto};
use halfrow_station::history::runs::{Filter, Place, page};
use halfrow_station::history::unit::units;
use halfrow_station::history::yields::{By, Wanted, Yield, yields};
use halfrow_station::store::{Folder, Snapshot};
use rusqlite::{Connection, Statement, params};

use super::made::{BEGIN_MS, DAY_MS, End, Made, Run, id};
use super::served::Served;

const LANES: u64 = 16;
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

/// What is true of the history.
#[derive(Default)]
struct Truth {
    /// Every judgement of a unit under plans of one name, whether it passed, in order.
    judged: BTreeMap<(u64, &'static str), Vec<bool>>,
    runs: BTreeMap<&'static str, u64>,
    errors: BTreeMap<&'static str, u64>,
    parts: BTreeMap<&'static str, u64>,
}

struct Generated {
    made: Made,
    truth: Truth,
    runs: u64,
}

fn serial(unit: u64) -> String {
    format!("CAT{unit:07}")
}

/// A history of so many runs, in a database as the first program made it, which the station then brings up to date.
fn generate(runs: u64) -> Generated {
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

/// What enters runs.
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

    /// Units come one after the other; one run in thirty is of an earlier unit.
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

/// Five minutes after one another in each lane.
fn started_ms(number: u64) -> i64 {
    BEGIN_MS + (number / LANES) as i64 * 300_000 + (number % LANES) as i64 * 1000
}

impl Generated {
    fn now(&self) -> Snapshot {
        self.made.now()
    }

    /// Compares all that is counted with the truth.
    fn compare(&self) {
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

/// What was counted when the database was brought up to date, and what is counted with each run, are one.
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

/// The 95th and the 99th percentile, and the longest.
fn slowest(mut times: Vec<Duration>) -> [Duration; 3] {
    times.sort_unstable();
    let at = |per_cent: usize| times[(times.len() * per_cent / 100).min(times.len() - 1)];
    [at(95), at(99), at(100)]
}

/// How long something took, and how long the processor was at it.
type Took = (Duration, Duration);

fn timed(act: impl FnOnce()) -> Took {
    let (begun, busy) = (Instant::now(), on_processor());
    act();
    (begun.elapsed(), on_processor() - busy)
}

/// How long this thread has had the processor.
fn on_processor() -> Duration {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    Duration::from_nanos(said.split(' ').next().unwrap().parse().unwrap())
}

/// Prints what whoever measures looks at.
#[allow(clippy::print_stdout)]
fn told(name: &str, times: Vec<Took>, wanted: &str) {
    let (wall, processor): (Vec<_>, Vec<_>) = times.into_iter().unzip();
    let ([p95, p99, most], [of_processor, ..]) = (slowest(wall), slowest(processor));
    println!(
        "{name:15}  p95 {p95:9.2?}, p99 {p99:9.2?}, longest {most:9.2?}, processor p95 {of_processor:9.2?}; {wanted}"
    );
}

/// A filter, now and then of several conditions.
fn filter(draw: &mut Draw, runs: u64) -> Filter {
    let mut filter = Filter::default();
    let verdicts = [Verdict::Pass, Verdict::Fail, Verdict::Error];
    filter.serial = (draw.below(5) == 0).then(|| serial(draw.below(runs)));
    filter.verdict = (draw.below(3) == 0).then(|| verdicts[draw.below(3) as usize]);
    filter.plan = (draw.below(3) == 0).then(|| ["final", "intake"][draw.below(2) as usize].to_owned());
    filter.lane = (draw.below(3) == 0).then(|| draw.below(LANES).to_string());
    filter.operator = (draw.below(3) == 0).then(|| format!("operator {}", draw.below(20)));
    filter
}

/// Prints how long each look takes, with the database in the computer's memory, as a station's is.
#[test]
#[ignore = "for scripts/soak"]
fn a_million_runs_are_looked_at_in_time() {
    let runs = std::env::var("HALFROW_STATION_RUNS").map_or(1_000_000, |runs| runs.parse().unwrap());
    let took = Instant::now();
    let mut made = generate(runs);
    let size = std::fs::metadata(made.made.folder().database()).unwrap().len() >> 20;
    println!("{runs} runs, {size} MiB, made in {:.0} s", took.elapsed().as_secs_f64());
    made.compare();
    let mut draw = Draw(2);
    let mut look = || {
        let filter = filter(&mut draw, made.runs);
        let started_ms = started_ms(draw.below(made.runs));
        let after = Place { started_ms, id: id(started_ms, 0) };
        timed(|| drop(page(&made.now(), &filter, Some(&after), 50).unwrap()))
    };
    told("page", (0..400).map(|_| look()).collect(), "wanted p95 50 ms");
    let mut look = || {
        let serial = serial(draw.below(made.runs));
        timed(|| drop(units(&made.now(), &serial).unwrap()))
    };
    told("unit", (0..400).map(|_| look()).collect(), "wanted p95 20 ms");
    let all = Wanted::default();
    for (name, by) in [("yield by day", By::Day), ("yield by plan", By::Plan)] {
        let look = |_| timed(|| drop(yields(&made.now(), &all, by).unwrap()));
        told(name, (0..20).map(look).collect(), "wanted 500 ms");
    }
    for (name, by) in [("pareto by part", Of::Part), ("pareto by check", Of::Check)] {
        let look = |_| timed(|| drop(pareto(&made.now(), &all, by).unwrap()));
        told(name, (0..20).map(look).collect(), "wanted 100 ms");
    }
    let (begun, ended) = commits(&mut made);
    told("begin", begun, "wanted p99 50 ms, while two look at all there is");
    told("end", ended, "wanted p99 50 ms, the record's bytes among it");
    served(made, &mut draw);
}

/// The same through the station's own program, without a browser.
fn served(Generated { made, runs, .. }: Generated, draw: &mut Draw) {
    let served = Served::of(made);
    let get = |path: &str| timed(|| drop(served.page(path)));
    let mut list = || {
        let started_ms = started_ms(draw.below(runs));
        let lane = if draw.below(2) == 0 { format!("&lane={}", draw.below(LANES)) } else { String::new() };
        get(&format!("/history?after={started_ms}.{}{lane}", id(started_ms, 0)))
    };
    told("/history", (0..400).map(|_| list()).collect(), "wanted p95 50 ms");
    // A unit is made by its first run; some numbers are of none.
    let units = (0..400).map(|_| {
        let path = format!("/unit?serial={}", serial(draw.below(runs)));
        timed(|| drop(served.get(&path)))
    });
    told("/unit", units.collect(), "wanted p95 20 ms");
    for (path, wanted) in [
        ("/yield", "wanted 500 ms"),
        ("/yield?by=day", "wanted 500 ms"),
        ("/pareto", "wanted 100 ms"),
        ("/pareto?by=check", "wanted 100 ms"),
    ] {
        told(path, (0..20).map(|_| get(path)).collect(), wanted);
    }
    let figures = || timed(|| assert_eq!(served.get("/metrics").status, 200));
    told("/metrics, first", vec![figures()], "it counts every FAIL there is");
    told("/metrics", (0..20).map(|_| figures()).collect(), "wanted 100 ms");
}

/// Runs that are begun and ended while two others look at all there is.
fn commits(of: &mut Generated) -> (Vec<Took>, Vec<Took>) {
    let (folder, all) = (of.made.folder(), Wanted::default());
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for by in [Of::Part, Of::Check] {
            let (folder, all, is_over) = (&folder, &all, &is_over);
            scope.spawn(move || {
                while !is_over.load(Ordering::Relaxed) {
                    let now = Snapshot::take(folder).unwrap();
                    drop(yields(&now, all, By::Day).unwrap());
                    drop(pareto(&now, all, by).unwrap());
                    drop(page(&now, &Filter::default(), None, 50).unwrap());
                }
            });
        }
        let last = started_ms(of.runs);
        let commit = |number: i64| {
            let end = if number % 20 == 0 { End::Fail(&["memory"]) } else { End::Pass };
            let run = Run { started_ms: last + number * 1000, ..Run::of(&format!("NEW{number}"), end) };
            let mut head = None;
            let begun = timed(|| head = Some(of.made.begin(&run)));
            let (head, plan) = head.unwrap();
            (begun, timed(|| of.made.finish(&run, head, plan)))
        };
        let times = (0..500).map(commit).unzip();
        is_over.store(true, Ordering::Relaxed);
        times
    })
}
