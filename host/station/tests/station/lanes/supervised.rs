//! A lane as its supervisor sees it.

use std::fs;
use std::mem;
use std::path::Path;
use std::thread;
use std::time::Duration;

use halfrow::verdict::StoppedBy;
use halfrow_station::lane::supervisor::{Attendant, End, Patience, supervise};
use halfrow_station::lane::{LaneJob, Message, Ruling};
use halfrow_station::record::BoardSeen;

use super::floor::HANG;
use crate::common::{PLAN, folder, program, script};

/// A station that takes this long for the first message.
struct Slow(Duration);

impl Attendant for Slow {
    fn stop(&mut self) -> Option<StoppedBy> {
        None
    }

    fn hear(&mut self, _: &Message) {
        thread::sleep(mem::take(&mut self.0));
    }

    fn rule(&mut self, _: &BoardSeen) -> Ruling {
        Ruling::New
    }
}

/// Both messages have arrived before the first one is taken.
const TWO: &str = r#"{"told":"frame","name":"frames"}\n{"told":"done"}\n"#;

/// The first message of the program's own lane.
fn begun() -> String {
    format!(r#"{{"told":"begun","program":"{}"}}\n"#, halfrow::VERSION)
}

/// The end of a lane that sends this as soon as it has its job, and then waits for an answer.
fn end_of(told: &str, silence: Duration, attendant: &mut dyn Attendant) -> End {
    let lane = format!("read -r job\nprintf '{told}'\nread -r more\n");
    end_of_script(&lane, String::new(), silence, attendant)
}

/// What a lane in `folder` is given to do, without a plan's text.
fn job(folder: &Path) -> LaneJob {
    LaneJob {
        run: "run".to_owned(),
        target: "mock".to_owned(),
        plan: folder.join("plan.toml"),
        text: String::new(),
        sha256: String::new(),
        variant: String::new(),
        seed: 0,
        is_mock: false,
        spool: folder.to_owned(),
        memory_mib: 4096,
    }
}

/// The end of a lane that runs this script, with a plan of this text.
fn end_of_script(lane: &str, text: String, silence: Duration, attendant: &mut dyn Attendant) -> End {
    end_in(folder().path(), (lane, text), Patience { silence, whole: HANG, tries: 2 }, attendant)
}

/// The same in this folder, within this patience.
fn end_in(
    folder: &Path,
    (lane, text): (&str, String),
    patience: Patience,
    attendant: &mut dyn Attendant,
) -> End {
    let lane = script(folder, "lane", lane);
    let job = LaneJob { text, memory_mib: 64, ..job(folder) };
    supervise(&lane, &job, folder, patience, attendant).end
}

#[test]
fn a_lane_is_not_silent_while_the_station_takes_what_it_told() {
    let silence = Duration::from_secs(8);
    let told = format!("{}{TWO}", begun());
    let slow = &mut Slow(silence + Duration::from_millis(100));
    assert_eq!(end_of(&told, silence, slow), End::Done);
}

/// A station that stands still, as when its computer sleeps, for these times when it is asked whether the run is to end.
struct Still(Vec<Duration>);

impl Attendant for Still {
    fn stop(&mut self) -> Option<StoppedBy> {
        thread::sleep(self.0.pop().unwrap_or_default());
        None
    }

    fn hear(&mut self, _: &Message) {}

    fn rule(&mut self, _: &BoardSeen) -> Ruling {
        Ruling::New
    }
}

#[test]
fn a_lane_is_not_silent_while_the_station_stands_still() {
    let silence = Duration::from_secs(2);
    let lane = format!("read -r job\nprintf '{}'\nsleep 1\nprintf '{TWO}'\nread -r more\n", begun());
    let still = &mut Still(vec![2 * silence]);
    assert_eq!(end_of_script(&lane, String::new(), silence, still), End::Done);
}

/// Its looks take longer than they should, and all of that time counts.
#[test]
fn a_silent_lane_is_killed_by_a_busy_station_too() {
    let lane = format!("read -r job\nprintf '{}'\nread -r more\n", begun());
    let mut busy = Still(vec![Duration::from_millis(300); 100]);
    let end = end_of_script(&lane, String::new(), Duration::from_secs(2), &mut busy);
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!(why.code, "lane-silent");
    assert!(busy.0.len() > 85, "{} looks", 100 - busy.0.len());
}

/// How it ended is the station's doing then, and says nothing of the lane.
#[test]
fn a_lane_that_closes_its_output_and_does_not_end_is_killed_for_that() {
    let lane = format!("read -r job\nprintf '{}'\nexec sleep 60 >&-\n", begun());
    let end = end_of_script(&lane, String::new(), HANG, &mut Slow(Duration::ZERO));
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!((why.code.as_str(), &why.parameters["seconds"]), ("lane-deaf", &10.0.into()));
}

/// Such as one whose step goes round in a circle: it would keep its board for ever.
#[test]
fn a_lane_that_takes_too_long_is_killed_however_much_it_tells() {
    let doing = r#"printf '{"told":"frame","name":"frames"}\n'; sleep 0.1"#;
    let patience = Patience { silence: HANG, whole: Duration::from_secs(1), tries: 2 };
    let ends = |rest: &str, patience| {
        let lane = format!("printf '{}'\n{rest}\nprintf '{TWO}'\nread -r more\n", begun());
        end_in(folder().path(), (&lane, String::new()), patience, &mut Slow(Duration::ZERO))
    };
    let end = ends(&format!("while :; do {doing}; done"), patience);
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!((why.code.as_str(), &why.parameters["seconds"]), ("lane-late", &1.0.into()));
    // The control: a lane that takes as long, and may.
    let for_long = format!("for _ in 1 2 3 4 5 6 7 8 9 10 11 12; do {doing}; done");
    assert_eq!(ends(&for_long, Patience { whole: HANG, ..patience }), End::Done);
}

/// docs/station-plans.md: no file of a run grows beyond 64 MiB. It would fill the station's disk, where verdicts are saved.
#[test]
fn what_a_lane_tells_is_written_down_up_to_64_mib() {
    let place = folder();
    let long =
        "printf '{\"told\":\"frame\",\"name\":\"'; head -c 30000000 /dev/zero | tr '\\0' x; printf '\"}\\n'";
    let lane = format!("printf '{}'\n{long}\n{long}\n{long}\nprintf '{TWO}'\nread -r more\n", begun());
    let patience = Patience { silence: HANG, whole: HANG, tries: 2 };
    let end = end_in(place.path(), (&lane, String::new()), patience, &mut Slow(Duration::ZERO));
    assert_eq!(end, End::Done);
    let kept = fs::read_to_string(place.path().join("events.jsonl")).unwrap();
    let long: Vec<_> = kept.lines().map(|line| line.len() > 30_000_000).collect();
    assert!(kept.len() <= 64 << 20, "{} bytes", kept.len());
    // What is short has room all the same.
    assert_eq!(long, [false, true, true, false, false]);
}

/// It would fill the station's memory.
#[test]
fn a_lane_whose_line_has_no_end_is_killed_and_quoted_in_part() {
    let endless = format!("printf '{}'\nexec tr '\\0' x < /dev/zero\n", begun());
    let end = end_of_script(&endless, String::new(), HANG, &mut Slow(Duration::ZERO));
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!((why.code.as_str(), &why.parameters["line"]), ("lane-told-nonsense", &"x".repeat(200).into()));
}

/// They would fill the station's memory, too.
#[test]
fn a_lane_that_ends_more_tries_than_its_plan_has_is_killed() {
    let step = r#"{"seq":1,"attempt":1,"name":"a","kind":"verify","outcome":"passed","cause":"none","exit_code":0,"started_ms":1,
        "ended_ms":2,"detail":"","remedy":null,"measurements":[],"suspects":[],"board":null,"evidence":null}"#;
    let ended = format!(r#"{{"told":"ended","step":{}}}\n"#, step.split_whitespace().collect::<String>());
    let endless = format!("printf '{}'\nwhile printf '{ended}'; do :; done\n", begun());
    let end = end_of_script(&endless, String::new(), HANG, &mut Slow(Duration::ZERO));
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!(why.code, "lane-told-nonsense");
    // The control: as many as the plan has.
    let told = format!("{}{ended}{ended}{TWO}", begun());
    assert_eq!(end_of(&told, HANG, &mut Slow(Duration::ZERO)), End::Done);
}

/// What the lane read need not be what the station read, however shortly before.
#[test]
fn a_lane_whose_plan_is_another_one_refuses_it() {
    let place = folder();
    let job = LaneJob { text: PLAN.to_owned(), sha256: "0".repeat(64), ..job(place.path()) };
    let patience = Patience { silence: HANG, whole: HANG, tries: 2 };
    let report = supervise(program(), &job, place.path(), patience, &mut Slow(Duration::ZERO));
    let End::Refused(why) = report.end else { panic!("{report:?}") };
    assert_eq!(why.code, "plan-changed");
    assert!(report.steps.is_empty(), "the board was not touched");
}

/// Where it writes down what it did must be there first.
#[test]
fn a_lane_whose_folder_cannot_be_made_is_told_with_the_folder() {
    let place = folder();
    let (taken, spool) = (place.path().join("taken"), place.path().join("taken/run"));
    fs::write(&taken, "").unwrap();
    let patience = Patience { silence: HANG, whole: HANG, tries: 2 };
    let report = supervise(program(), &job(place.path()), &spool, patience, &mut Slow(Duration::ZERO));
    let End::Died(why) = report.end else { panic!("{report:?}") };
    assert_eq!(why.code, "evidence-folder-unusable");
    assert!(why.message.contains(&spool.display().to_string()), "{why}");
}

/// Its job is longer than what a pipe holds.
#[test]
fn a_lane_that_reads_nothing_is_silent() {
    let text = "#".repeat(1 << 20);
    let end = end_of_script("sleep 30\n", text, Duration::from_secs(1), &mut Slow(Duration::ZERO));
    let End::Killed(why) = end else { panic!("{end:?}") };
    assert_eq!(why.code, "lane-silent");
}

#[test]
fn a_lane_of_another_program_is_refused_with_what_to_do() {
    let other = begun().replace(halfrow::VERSION, "0.0.9");
    let late = format!("{TWO}{}", begun());
    for told in [&other, TWO, &late] {
        let end = end_of(told, HANG, &mut Slow(Duration::ZERO));
        let End::Refused(why) = end else { panic!("{told}: {end:?}") };
        assert_eq!(why.code, "lane-of-other-program", "{told}");
        assert!(why.message.ends_with("; start the station again"), "{why}");
    }
}
