//! How long each query of a million runs takes.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use halfrow::Verdict;
use halfrow_station::history::pareto::{Of, pareto};
use halfrow_station::history::runs::{Cursor, Filter, page};
use halfrow_station::history::unit::units;
use halfrow_station::history::yields::{By, Wanted, yields};
use halfrow_station::store::Snapshot;

use super::generated::{Draw, Generated, LANES, generate, serial, started_ms};
use super::made::{End, Run, id};
use super::served::Served;
use crate::pages::http::Response;

/// The 95th and the 99th percentile, and the longest time.
fn slowest(mut times: Vec<Duration>) -> [Duration; 3] {
    times.sort_unstable();
    let at = |per_cent: usize| times[(times.len() * per_cent / 100).min(times.len() - 1)];
    [at(95), at(99), at(100)]
}

/// How long something took, and for how long it had the processor.
type Took = (Duration, Duration);

fn timed(act: impl FnOnce()) -> Took {
    let (begun, busy) = (Instant::now(), on_processor());
    act();
    (begun.elapsed(), on_processor() - busy)
}

/// For how long this thread has had the processor.
fn on_processor() -> Duration {
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    Duration::from_nanos(said.split(' ').next().unwrap().parse().unwrap())
}

/// Prints the figures of a measurement.
#[allow(clippy::print_stdout)]
fn told(name: &str, times: Vec<Took>, wanted: &str) {
    let (wall, processor): (Vec<_>, Vec<_>) = times.into_iter().unzip();
    let ([p95, p99, most], [of_processor, ..]) = (slowest(wall), slowest(processor));
    println!(
        "{name:15}  p95 {p95:9.2?}, p99 {p99:9.2?}, longest {most:9.2?}, processor p95 {of_processor:9.2?}; {wanted}"
    );
}

/// A filter, at times with several conditions.
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

/// How many runs are made.
pub(crate) fn wanted_runs() -> u64 {
    std::env::var("HALFROW_STATION_RUNS").map_or(1_000_000, |runs| runs.parse().unwrap())
}

/// Prints how long each query takes, with the database cached in memory, as a station's is.
#[test]
#[ignore = "for scripts/soak"]
fn a_million_runs_are_looked_at_in_time() {
    let took = Instant::now();
    let mut made = generate(wanted_runs());
    let runs = made.runs;
    let size = std::fs::metadata(made.made.folder().database()).unwrap().len() >> 20;
    println!("{runs} runs, {size} MiB, made in {:.0} s", took.elapsed().as_secs_f64());
    made.compare();
    let mut draw = Draw(2);
    let mut look = || {
        let filter = filter(&mut draw, made.runs);
        let started_ms = started_ms(draw.below(made.runs));
        let after = Cursor { started_ms, id: id(started_ms, 0) };
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
    let Generated { made, runs, .. } = made;
    let station = Served::of(made);
    served(&|path| station.get(path), runs, &mut draw);
}

/// The same through the pages that the program serves, without a browser.
pub(crate) fn served(get: &dyn Fn(&str) -> Response, runs: u64, draw: &mut Draw) {
    let page = |path: &str| timed(|| assert_eq!(get(path).status, 200, "{path}"));
    let mut list = || {
        let started_ms = started_ms(draw.below(runs));
        let lane = if draw.below(2) == 0 { format!("&lane={}", draw.below(LANES)) } else { String::new() };
        page(&format!("/history?after={started_ms}.{}{lane}", id(started_ms, 0)))
    };
    told("/history", (0..400).map(|_| list()).collect(), "wanted p95 50 ms");
    // A unit exists from its first run on; some numbers have none.
    let units = (0..400).map(|_| {
        let path = format!("/unit?serial={}", serial(draw.below(runs)));
        timed(|| assert!([200, 404].contains(&get(&path).status), "{path}"))
    });
    told("/unit", units.collect(), "wanted p95 20 ms");
    for (path, wanted) in [
        ("/yield", "wanted 500 ms"),
        ("/yield?by=day", "wanted 500 ms"),
        ("/pareto", "wanted 100 ms"),
        ("/pareto?by=check", "wanted 100 ms"),
    ] {
        told(path, (0..20).map(|_| page(path)).collect(), wanted);
    }
    told("/metrics, first", vec![page("/metrics")], "it counts every FAIL there is");
    told("/metrics", (0..20).map(|_| page("/metrics")).collect(), "wanted 100 ms");
}

/// Times runs that begin and end while two other threads query everything.
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
