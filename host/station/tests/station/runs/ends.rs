//! Every way in which a run can end.

use std::net::{TcpListener, TcpStream};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use halfrow::Verdict;
use halfrow::verdict::StoppedBy;
use halfrow_station::lane::child::{carry_out, orders};
use halfrow_station::lane::{Control, LaneJob, MEMORY_MIB, Message, Ruling};
use halfrow_station::plan::Plan;
use halfrow_station::record::{RunCause, StepOutcome, StepRecord};
use nix::sys::signal::Signal;

use super::bench::{Did, PLAN, Station};
use super::identity::{device, one_after_the_other};
use crate::common::{exists, lane_process, signal, silent_board};
use crate::lanes::ends::connected;

#[test]
fn a_sound_board_passes_and_its_record_reads_back() {
    let station = Station::with(PLAN);
    let did = station.run("CAT00001", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(did.said.starts_with("PASS CAT00001: "), "{did:?}");
    assert!(did.said.contains("identity not checked"), "{did:?}");
    assert!(did.said.contains("counts as no production"), "{did:?}");
    let (stored, record, json) = station.saved(&did);
    assert_eq!((stored.verdict, stored.nth), (Verdict::Pass, 1));
    assert!(did.said.contains(&stored.record_sha256));
    assert_eq!(
        super::bench::sha256sum(&station.store().blobs().path(&stored.record_sha256)),
        stored.record_sha256
    );
    let steps: Vec<_> = record.steps.iter().map(|step| (step.name.as_str(), step.outcome.as_ref())).collect();
    assert_eq!(steps, [("identity", "passed"), ("verify", "passed")]);
    assert_eq!(record.plan.text, PLAN);
    assert_eq!(json["run"]["operator"], "weber");
    assert_eq!(json["steps"][1]["evidence"]["verdict"], "PASS");
    // W/2 + L of DATAPATH.md; the mock's L is 12.
    assert_eq!(json["steps"][1]["measurements"][0]["value"], 32.0 + f64::from(latency(&json)));
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

fn latency(record: &serde_json::Value) -> u8 {
    serde_json::from_value(record["steps"][1]["evidence"]["board"]["identity"]["latency"].clone()).unwrap()
}

#[test]
fn a_broken_board_fails_with_a_suspect_and_evidence() {
    let station = Station::with(PLAN);
    let did = station.run("CAT00001", "mock,fault=stuck-data");
    assert_eq!(did.code, Some(1), "{did:?}");
    assert!(did.said.starts_with("FAIL CAT00001: "), "{did:?}");
    let (stored, record, _) = station.saved(&did);
    assert_eq!((stored.verdict, record.suspects.is_empty()), (Verdict::Fail, false));
    assert_eq!(record.attachments[0].name, "events.jsonl");
    assert_eq!(station.query("SELECT part FROM suspect WHERE rank = 1"), [record.suspects[0].part.clone()]);
    assert_eq!(station.query("SELECT cause FROM run"), ["board"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

#[test]
fn a_board_that_is_not_there_is_an_error_of_the_link() {
    let plan = PLAN.replace("timeout = 60", "timeout = 60\nretries = 1");
    let station = Station::with(&plan);
    // The port of a connection's other end: nobody listens there, and nobody else can take it meanwhile.
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    let did = station.run("CAT00001", &format!("tcp:{}", taken.local_addr().unwrap()));
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.starts_with("ERROR CAT00001: "), "{did:?}");
    assert_eq!(station.query("SELECT outcome FROM step ORDER BY seq"), ["error", "skipped"]);
    assert_eq!(station.query("SELECT verdict FROM run"), ["ERROR"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

#[test]
fn a_build_that_the_plan_does_not_name_is_refused_before_a_frame_is_sent() {
    let station = Station::with(&PLAN.replace("\"00000000\"", "\"99bff58a\""));
    let did = station.run("CAT00001", "mock");
    assert_eq!(did.code, Some(6), "{did:?}");
    assert!(did.said.contains("the plan takes 99bff58a"), "{did:?}");
    let station = Station::with(&PLAN.replace("require_hardware = false", "require_hardware = true"));
    let did = station.run("CAT00001", "mock");
    assert_eq!(
        (did.code, station.query("SELECT cause FROM run")),
        (Some(5), vec!["refused".to_owned()]),
        "{did:?}"
    );
    assert!(did.said.contains("the board is a mock, but the plan takes only hardware"), "{did:?}");
    assert_eq!(
        (station.saved(&did).1.production, did.said.contains("the board is no hardware")),
        (false, true),
        "{did:?}"
    );
}

/// [`PLAN`] with a step that tests the link.
pub(crate) fn with_link() -> String {
    PLAN.replace("[[step]]", "[[step]]\nkind = \"link\"\nseconds = 0.01\n[[step]]")
}

/// What each value of `blames` makes of a PASS.
#[test]
fn a_limit_that_is_missed_blames_whom_the_plan_says() {
    for (blames, code, verdict) in [("board", 1, "FAIL"), ("station", 3, "ERROR"), ("nobody", 0, "PASS")] {
        let limit = format!("[limits]\n\"latency.clocks\" = {{ most = 10, blames = \"{blames}\" }}\n");
        let station = Station::with(&format!("{PLAN}{limit}"));
        let did = station.run("CAT00001", "mock");
        assert_eq!(did.code, Some(code), "{blames}: {did:?}");
        assert!(did.said.starts_with(verdict), "{did:?}");
        let measured = "SELECT outcome FROM measurement WHERE name = 'latency.clocks'";
        assert_eq!(station.query(measured), ["failed"]);
        // If the board is wrong as well, the same limit says whether it was judged correctly.
        let wrong = station.run("CAT00002", "mock,fault=stuck-data");
        assert_eq!(wrong.code, Some(if blames == "station" { 3 } else { 1 }), "{blames}: {wrong:?}");
        if blames == "station" {
            are_not_believed(&station, &wrong);
        }
    }
}

/// What the steps of this run found is recorded, and nothing of it is told as a result.
fn are_not_believed(station: &Station, did: &Did) {
    assert!(did.said.contains("Have an engineer look at this lane, or at the limit in the plan"), "{did:?}");
    assert!(!did.said.contains("set the board aside"), "{did:?}");
    let (_, record, _) = station.saved(did);
    assert_eq!((record.suspects.len(), record.steps[1].suspects.is_empty()), (0, false));
    assert_eq!(record.conclusion.remedy, record.steps[1].remedy);
    assert_eq!(station.query("SELECT count(*) FROM suspect"), ["0"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

/// A limit on the whole run is judged after the steps.
#[test]
fn steps_are_not_believed_either_where_the_run_was_too_long_for_the_station() {
    let limit = "[limits]\n\"run.seconds\" = { most = 1e-6, blames = \"station\" }\n";
    let station = Station::with(&format!("{PLAN}{limit}"));
    let did = station.run("CAT00001", "mock,fault=stuck-data");
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(!did.said.contains("set the board aside"), "{did:?}");
    assert!(station.saved(&did).1.suspects.is_empty());
}

#[test]
fn a_board_that_answers_the_link_test_wrong_fails_and_is_judged_no_further() {
    let station = Station::with(&with_link());
    let did = station.run("CAT00001", "mock,fault=row-factor,row=100,bit=0");
    assert_eq!(did.code, Some(1), "{did:?}");
    assert!(did.said.contains("answers hold other bytes than were sent"), "{did:?}");
    assert_eq!(station.query("SELECT outcome FROM step ORDER BY seq"), ["passed", "failed", "skipped"]);
}

#[test]
fn a_limit_on_what_nobody_can_measure_is_no_pass() {
    let limit = "[limits]\n\"link.to_board\" = { least = 1, blames = \"station\" }\n";
    let station = Station::with(&format!("{}{limit}", with_link()));
    let did = station.run("CAT00001", "mock");
    // The wire of a mock takes no time, so nothing can be measured.
    assert_eq!(did.code, Some(6), "{did:?}");
    assert!(did.said.contains("link.to_board could not be measured"), "{did:?}");
    assert_eq!(station.query("SELECT outcome FROM step ORDER BY seq"), ["passed", "error", "skipped"]);
}

#[test]
fn the_unit_counts_its_judgements_and_errors_use_up_none() {
    let station = Station::with(PLAN);
    for board in ["mock,fault=stuck-data", "tcp:127.0.0.1:1", "mock"] {
        station.run("CAT00001", board);
    }
    station.run("CAT00002", "mock");
    assert_eq!(station.query("SELECT nth FROM run ORDER BY id"), ["1", "2", "2", "1"]);
    assert_eq!(station.query("SELECT fence FROM run ORDER BY id"), ["1", "2", "3", "4"]);
    assert_eq!(station.query("SELECT count(*) FROM unit"), ["2"]);
    assert_eq!(station.query("SELECT count(*) FROM plan"), ["1"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

#[test]
fn a_call_that_is_wrong_begins_no_run() {
    let station = Station::with(PLAN);
    let did = station.run("CAT1", "mock");
    assert_eq!(did.code, Some(2), "{did:?}");
    assert!(did.complained.contains("`CAT1` is no serial number of this product"), "{did:?}");
    for wrong in [
        "tcp:127.0.0.1:99999",
        "tcp:127.0.0.1:3001,baud=0",
        "mock,fault=nope",
        "mock,serial=1234567890123456789",
        "serial:/dev/null",
        "serial:/etc/passwd",
    ] {
        let did = station.run("CAT00001", wrong);
        assert_eq!((did.code, did.said.as_str()), (Some(2), ""), "{wrong}: {did:?}");
    }
    station.plan(&PLAN.replace("schema = 1", "schema = 9"));
    assert_eq!(station.run("CAT00001", "mock").code, Some(2));
    assert!(!station.data().exists());
}

/// The process id of the lane, once it has connected to the board and the station has heard from it.
pub(crate) fn lane_of(station: &Station, listener: &TcpListener) -> u32 {
    connected(listener);
    let spool = std::fs::read_dir(station.data().join("spool")).unwrap().next().unwrap().unwrap().path();
    let begun = Instant::now();
    loop {
        let told = std::fs::read_to_string(spool.join("events.jsonl")).unwrap_or_default();
        if let Some(process) = lane_process(&spool).filter(|_| told.ends_with('\n')) {
            return process;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "no lane");
    }
}

#[test]
fn a_lane_that_hangs_is_killed_and_recorded() {
    let station = Station::with(PLAN);
    let (listener, target) = silent_board();
    let running = station.begin("CAT00001", &target, &["--silence", "5"]);
    let lane = lane_of(&station, &listener);
    signal(lane, Signal::SIGSTOP);
    let did = Did::from(running.wait_with_output().unwrap());
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.contains("the lane sent nothing for 5 s"), "{did:?}");
    assert!(!exists(lane), "the lane is gone");
    assert_eq!(station.query("SELECT cause FROM run"), ["crash"]);
    assert_eq!(station.run("CAT00001", "mock").code, Some(0));
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

#[test]
fn a_lane_that_dies_is_recorded() {
    let station = Station::with(PLAN);
    let (listener, target) = silent_board();
    let running = station.begin("CAT00001", &target, &[]);
    signal(lane_of(&station, &listener), Signal::SIGKILL);
    let did = Did::from(running.wait_with_output().unwrap());
    assert_eq!(did.code, Some(3), "{did:?}");
    assert!(did.said.contains("the lane ended before it was done (signal: 9"), "{did:?}");
    assert_eq!(station.query("SELECT cause FROM run"), ["crash"]);
}

#[test]
fn a_run_that_is_stopped_ends_in_order() {
    let station = Station::with(PLAN);
    let (listener, target) = silent_board();
    let running = station.begin("CAT00001", &target, &[]);
    lane_of(&station, &listener);
    signal(running.id(), Signal::SIGINT);
    let did = Did::from(running.wait_with_output().unwrap());
    assert_eq!(did.code, Some(130), "{did:?}");
    assert_eq!(station.query("SELECT cause FROM run"), ["operator"]);
}

/// The station is killed in the middle of a run: its lane ends with it, and the run becomes an ERROR at the next start.
#[test]
fn a_run_that_is_found_open_is_an_error() {
    let station = Station::with(PLAN);
    let (listener, target) = silent_board();
    let mut running = station.begin("CAT00001", &target, &[]);
    let lane = lane_of(&station, &listener);
    signal(running.id(), Signal::SIGKILL);
    running.wait().unwrap();
    let begun = Instant::now();
    while exists(lane) {
        assert!(begun.elapsed() < Duration::from_secs(60), "the lane outlives its station");
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(station.query("SELECT state FROM run"), ["open"]);
    let checked = station.check();
    assert_eq!(checked.code, Some(0), "{checked:?}");
    assert!(checked.said.contains("1 run is open"), "{checked:?}");
    let did = station.run("CAT00002", "mock");
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(did.complained.contains("of CAT00001 was found open, and is ERROR"), "{did:?}");
    assert_eq!(
        station.query("SELECT verdict || ' ' || cause FROM run ORDER BY id"),
        ["ERROR crash", "PASS none"]
    );
    let attached = "SELECT name FROM attachment";
    assert_eq!(station.query(attached), ["events.jsonl"]);
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}

/// The link fails while a person ends the run.
#[test]
fn no_step_is_tried_again_once_the_run_is_to_end() {
    let text = PLAN.replace("timeout = 60", "timeout = 60\nretries = 3");
    let target = one_after_the_other(vec![device(0x11)], || ());
    let steps = stopped(text, target, |message| matches!(message, Message::Step { seq: 2, .. }));
    let tries: Vec<_> = steps.iter().map(|step| (step.seq, step.attempt)).collect();
    assert_eq!(tries, [(1, 1), (2, 1)]);
}

/// The finished tries of the steps of a lane that a person stops at the first message that `is_last`.
fn stopped(text: String, target: String, is_last: impl Fn(&Message) -> bool + Sync) -> Vec<StepRecord> {
    let spool = crate::common::folder();
    let path = spool.path().join("plan.toml");
    let plan = Plan::parse(&path, text.clone()).unwrap();
    let (orders, heeded) = orders();
    let tries = Mutex::new(Vec::new());
    let tell = |message: &Message| {
        match message {
            Message::Identified { .. } => orders.take(Control::Device(Ruling::New)),
            Message::Ended { step } => tries.lock().unwrap().push(StepRecord::clone(step)),
            _ => {}
        }
        if is_last(message) {
            orders.take(Control::Stop(StoppedBy::Person));
        }
    };
    let [run, variant] = ["r", ""].map(str::to_owned);
    let spool = spool.path().to_owned();
    let job = LaneJob {
        run,
        target,
        plan: path,
        text,
        sha256: plan.sha256,
        variant,
        seed: 1,
        is_mock: false,
        spool,
        memory_mib: MEMORY_MIB,
    };
    carry_out(&job, &heeded, &tell);
    tries.into_inner().unwrap()
}

/// What had come back by then is not judged, but it is reported.
#[test]
fn a_run_that_is_stopped_tells_with_its_figures_that_samples_differed_by_then() {
    let text = PLAN.replace("timeout = 60", "timeout = 60\nrepeat = 1000");
    let frames = AtomicUsize::new(0);
    let is_last = |message: &Message| {
        let is_frame = matches!(message, Message::Frame { name } if name == "builtin:noise");
        is_frame && frames.fetch_add(1, Ordering::Relaxed) == 40
    };
    let steps = stopped(text, "mock,fault=stuck-data".to_owned(), is_last);
    let last = steps.last().unwrap();
    assert_eq!((last.outcome, last.cause), (StepOutcome::Error, RunCause::Operator), "{last:?}");
    let measured = last.measurements.iter().find(|one| one.name == "frames.samples_differing").unwrap();
    let finding = last.finding.as_ref().unwrap();
    assert_eq!(finding.code, "stopped-by-signal");
    let differed = |name: &str| finding.parameters["differed"][name].as_u64().unwrap();
    assert!(measured.value.unwrap() > 0.0, "{last:?}");
    assert_eq!(Some(differed("differences") as f64), measured.value);
    // The judge's own sentence has the same figures.
    let [differences, samples, wrong, frames] =
        ["differences", "samples", "differing_frames", "frames"].map(differed);
    let told = format!("{differences} of {samples} samples differ in {wrong} of {frames} frames");
    assert!(finding.message.replace(',', "").starts_with(&told), "{finding}");
}

/// Only the first try finds the board late. The mock's latency option is its L, to which W/2 is added.
#[test]
fn a_limit_that_only_the_first_try_of_a_step_missed_stays_told() {
    let limit = "[limits]\n\"latency.clocks\" = { most = 44, blames = \"station\" }\n";
    let station =
        Station::with(&format!("{}{limit}", PLAN.replace("timeout = 60", "timeout = 60\nretries = 1")));
    let late = format!("{},latency=13", device(0x11));
    let boards = vec![device(0x11), late, device(0x11)];
    let did = station.run("CAT00001", &one_after_the_other(boards, || ()));
    assert_eq!(did.code, Some(0), "{did:?}");
    assert!(did.said.contains("marginal  a step needed more than one try"), "{did:?}");
    let tries = "SELECT attempt || ' ' || outcome FROM step WHERE name = 'verify' ORDER BY attempt";
    assert_eq!(station.query(tries), ["1 error", "2 passed"]);
    let clocks = "SELECT attempt || ' ' || value || ' ' || outcome FROM measurement WHERE name = 'latency.clocks' ORDER BY attempt";
    assert_eq!(station.query(clocks), ["1 45.0 failed", "2 44.0 passed"]);
    let (_, record, _) = station.saved(&did);
    assert!(record.marginal && record.steps[1].detail.starts_with("latency.clocks is 45"), "{record:?}");
    assert_eq!(station.check().code, Some(0), "{:?}", station.check());
}
