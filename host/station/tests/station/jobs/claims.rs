//! Who has a job: one at a time; the last one is sure to have it, and only that one's run counts.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::thread;

use halfrow::Verdict;
use halfrow_station::record::{JobClaim, Record, RunCause};
use halfrow_station::store::{
    Claim, Entry, JobState, Kind, Parcel, Plant, Snapshot, Turn, Waiter, Wanted, Worker, jobs,
};

use super::{add, any, board, job, plan, run_out, shared, states, with_a_job, worker};
use crate::common::{engel, reason};
use crate::history::made::{BEGIN_MS, End, Made, Run};
use crate::plant::checked::faults;
use crate::plant::server::Server;

/// The `number`-th run of this unit, in the form in which its station sends it.
fn run_of_unit(serial: &str, number: u32, end: End) -> Parcel {
    let mut made = Made::new();
    let run = Run { started_ms: BEGIN_MS + i64::from(number), ..Run::of(serial, end) };
    let subject = made.numbered(number, &run);
    made.folder().parcel(&Entry { kind: Kind::Run, subject, attempts: 0 }).unwrap()
}

/// Like [`run_of_unit`], for a claim.
pub(super) fn run_of(claim: &Claim, number: u32, end: End) -> Parcel {
    with_record(run_of_unit(claim.serial(), number, end), |record| {
        record.run.job = Some(JobClaim { id: claim.job.clone(), fence: claim.fence });
    })
}

/// The parcel of a run whose record is changed so.
pub(super) fn with_record(parcel: Parcel, change: impl FnOnce(&mut Record)) -> Parcel {
    let Parcel::Run { mut record, .. } = parcel else { panic!("it is a run") };
    change(&mut record);
    let text = serde_json::to_string(&record).unwrap();
    assert_eq!(Record::parse(text.as_bytes()).unwrap(), *record);
    let sha256 = halfrow::result::sha256([text.as_bytes()]);
    Parcel::Run { record, text, sha256 }
}

#[test]
fn a_job_is_had_by_one_at_a_time_and_so_is_a_board() {
    let (server, mut plant) = shared(4);
    add(&mut plant, 40);
    let held = Mutex::new((Vec::<String>::new(), Vec::new()));
    thread::scope(|scope| {
        for number in 0..8 {
            let (held, server) = (&held, &server);
            scope.spawn(move || {
                let mut plant = Plant::connect(&server.address()).unwrap();
                let worker = worker(&format!("station {number}"));
                let mut runs = number * 1000;
                while !server.rows("SELECT 1 FROM job WHERE state <> 'done' LIMIT 1").is_empty() {
                    let Some(claim) = plant.claim(&worker).unwrap() else { continue };
                    {
                        let mut held = held.lock().unwrap();
                        assert!(!held.0.contains(&claim.lease.board), "{claim:?} is had by {:?}", held.0);
                        held.0.push(claim.lease.board.clone());
                        held.1.push(claim.job.clone());
                    }
                    assert!(plant.renew_claim(&claim).unwrap());
                    runs += 1;
                    plant.take(&run_of(&claim, runs, End::Pass)).unwrap();
                    held.lock().unwrap().0.retain(|board| *board != claim.lease.board);
                    plant.give_back(&claim.lease).unwrap();
                }
            });
        }
    });
    let mut claimed = held.into_inner().unwrap().1;
    claimed.sort();
    claimed.dedup();
    assert_eq!(claimed.len(), 40, "each was claimed");
    assert_eq!(server.rows("SELECT count(*), count(DISTINCT id), sum(fence) FROM job"), [["40", "40", "40"]]);
    let once = "SELECT count(*) FROM run JOIN job ON job.run_id = run.id WHERE verdict = 'PASS'";
    assert_eq!(server.rows(once), [["40"]]);
}

/// docs/plant.md: for 30 s by the plant's clock, from when it was given or renewed last.
#[test]
fn a_job_and_a_board_are_held_for_half_a_minute() {
    let (server, mut plant, _) = with_a_job();
    plant.share(&board(2, "ulx3s"), "engel").unwrap();
    let one = |text: &str| -> i64 { server.rows(text)[0][0].parse().unwrap() };
    let now_ms = || one("SELECT CAST(extract(epoch FROM clock_timestamp()) * 1000 AS BIGINT)");
    let assert_held = |since_ms: i64, of: &str| {
        let given_ms = one(&format!("SELECT until_ms FROM {of}")) - 30_000;
        assert!((since_ms..=now_ms()).contains(&given_ms), "{of}: {given_ms}, and not since {since_ms}");
    };
    let since_ms = now_ms();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    assert_held(since_ms, "job");
    assert_held(since_ms, "board WHERE name = 'shelf-0'");
    run_out(&server);
    let since_ms = now_ms();
    assert!(plant.renew_claim(&claim).unwrap());
    assert_held(since_ms, "job");
    assert_held(since_ms, "board WHERE name = 'shelf-0'");
    let since_ms = now_ms();
    let turn = plant.wait(&Waiter::new("ulx3s", "weber", "12", now_ms()).unwrap()).unwrap();
    assert!(matches!(turn, Turn::Held(_)), "{turn:?}");
    assert_held(since_ms, "board WHERE name = 'shelf-2'");
}

/// What a worker does that was stopped for too long, and what the next one does. Returns `nth` of all runs, 0 for one that does
/// not count.
pub(crate) fn late(is_fenced: bool) -> (Server, Vec<Vec<String>>) {
    let (server, mut plant, _) = with_a_job();
    let first = plant.claim(&worker("first")).unwrap().unwrap();
    run_out(&server);
    let second = plant.claim(&worker("second")).unwrap().unwrap();
    assert_eq!((first.fence, second.fence, second.lease.fence), (1, 2, 2));
    assert!(!plant.renew_claim(&first).unwrap() && plant.renew_claim(&second).unwrap());
    plant.give_back(&first.lease).unwrap();
    assert!(plant.renew_claim(&second).unwrap(), "a board is not given back by who does not have it");
    for (claim, number) in [(&first, 2), (&second, 3), (&first, 2)] {
        let Parcel::Run { mut record, mut text, mut sha256 } = run_of(claim, number, End::Pass) else {
            panic!("it is a run")
        };
        if !is_fenced {
            record.run.job = None;
            text = serde_json::to_string(&record).unwrap();
            sha256 = halfrow::result::sha256([text.as_bytes()]);
        }
        plant.take(&Parcel::Run { record, text, sha256 }).unwrap();
    }
    let judged = server.rows("SELECT nth FROM run ORDER BY id");
    (server, judged)
}

#[test]
fn a_run_of_a_claim_that_was_lost_is_kept_and_does_not_count() {
    let (server, judged) = late(true);
    assert_eq!(judged, [["0"], ["1"]]);
    assert_eq!(server.rows("SELECT runs, units, passed FROM day_count"), [["1", "1", "1"]]);
    let done = server.rows("SELECT job.state, run.nth FROM job JOIN run ON run.id = job.run_id");
    assert_eq!(done, [["done", "1"]]);
    // Nor does it count when an earlier run of the unit comes later and is counted before it.
    let mut plant = Plant::connect(&server.address()).unwrap();
    plant.take(&run_of_unit(&board(0, "mock").serial, 1, End::Fail(&["clock"]))).unwrap();
    assert_eq!(server.rows("SELECT nth FROM run ORDER BY id"), [["1"], ["0"], ["2"]]);
    assert_well(&server);
    // The control: without the fence both count.
    let (server, judged) = late(false);
    assert_eq!(judged, [["1"], ["2"]]);
    assert_eq!(server.rows("SELECT sum(runs) FROM day_count"), [["2"]]);
}

/// Only the plant knows that it does not count: its record looks like the one that does.
#[test]
fn an_error_of_a_claim_that_was_lost_counts_nowhere_and_is_no_fault() {
    let (server, mut plant, _) = with_a_job();
    let first = plant.claim(&worker("first")).unwrap().unwrap();
    run_out(&server);
    let second = plant.claim(&worker("second")).unwrap().unwrap();
    for (claim, number) in [(&first, 2), (&second, 3)] {
        plant.take(&run_of(claim, number, End::Error(RunCause::Link))).unwrap();
    }
    assert_eq!(server.rows("SELECT nth FROM run ORDER BY id"), [["0"], ["1"]]);
    assert_eq!(server.rows("SELECT runs, errors FROM day_count"), [["1", "1"]]);
    assert_well(&server);
}

#[test]
fn what_judged_nothing_is_given_back_five_times_and_then_waits_for_a_person() {
    let (server, mut plant, id) = with_a_job();
    for number in 1..=5 {
        let claim = plant.claim(&worker("12")).unwrap().unwrap();
        match number {
            // A worker that vanished (twice), a board that is no board, and runs that are an ERROR.
            1 | 2 => run_out(&server),
            3 => plant.fail(&claim, "it is no board").unwrap(),
            _ => plant.take(&run_of(&claim, number, End::Error(RunCause::Link))).unwrap(),
        }
        plant.give_back(&claim.lease).unwrap();
    }
    assert_eq!(plant.claim(&worker("12")).unwrap(), None);
    assert_eq!(states(&server), [["dead", "5"]]);
    assert!(plant.retry_job(&id, engel(&reason("the cable is new"))).unwrap());
    assert!(!plant.retry_job(&id, engel(&reason("twice"))).unwrap());
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    // A job that was not begun costs no attempt.
    plant.decline(&claim, None).unwrap();
    assert_eq!(states(&server), [["waiting", "0"]]);
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    plant.take(&run_of(&claim, 9, End::Fail(&["clock"]))).unwrap();
    let counts = Snapshot::of_plant(plant).unwrap().run_of_job(&id).unwrap().flatten();
    assert_eq!(counts, server.rows("SELECT max(id) FROM run").concat().pop());
    let verdicts = server.rows("SELECT verdict FROM run ORDER BY id");
    assert_eq!(verdicts, [["ERROR"], ["ERROR"], [Verdict::Fail.to_string().as_str()]]);
}

/// Nobody else asks for a job, so that nothing is written down of the lease that ran out.
#[test]
fn a_job_is_listed_as_what_the_next_claim_makes_of_it() {
    let (server, mut plant, id) = with_a_job();
    for (claims, expected) in [(1, JobState::Waiting), (4, JobState::Dead)] {
        for _ in 0..claims {
            run_out(&server);
            plant.claim(&worker("away")).unwrap().unwrap();
        }
        run_out(&server);
        let now = Snapshot::of_plant(Plant::connect(&server.address()).unwrap()).unwrap();
        for state in [JobState::Waiting, JobState::Claimed, JobState::Done, JobState::Dead] {
            let listed: Vec<_> = jobs(&now, &[state], "", 9).unwrap().iter().map(|job| job.state).collect();
            assert_eq!(listed, vec![expected; usize::from(state == expected)], "{state:?}");
        }
    }
    assert_eq!(states(&server), [["claimed", "5"]], "nobody has asked");
    assert!(plant.retry_job(&id, engel(&reason("the cable is new"))).unwrap());
    assert!(plant.claim(&worker("12")).unwrap().is_some());
}

/// A plant whose job was claimed as often as this before the plant was put back to when nobody had claimed it, and the last claim.
fn put_back(claims: usize) -> (Server, Plant, Claim) {
    let (server, mut plant, _) = with_a_job();
    let claimed = (0..claims).map(|_| {
        run_out(&server);
        plant.claim(&worker("before")).unwrap().unwrap()
    });
    let last = claimed.last().unwrap();
    let back = "UPDATE job SET state = 'waiting', fence = 0, attempts = 0, holder = NULL, until_ms = NULL;
        UPDATE board SET fence = 0, holder = NULL, until_ms = NULL";
    server.change(back);
    (server, plant, last)
}

/// A claim that the plant has forgotten is later than all that it knows of.
#[test]
fn a_claim_from_before_a_plant_was_put_back_is_not_mistaken_for_an_earlier_one() {
    // It judged nothing: the next claim counts, and is no other one.
    let (server, mut plant, last) = put_back(2);
    let error = run_of(&last, 1, End::Error(RunCause::Link));
    plant.take(&error).unwrap();
    let next = plant.claim(&worker("next")).unwrap().unwrap();
    assert_eq!(next.fence, 3);
    plant.take(&error).unwrap();
    assert!(plant.renew_claim(&next).unwrap());
    plant.take(&run_of(&next, 2, End::Pass)).unwrap();
    assert_eq!(server.rows("SELECT nth FROM run ORDER BY id"), [["1"], ["1"]]);
    assert_well(&server);
    // Somebody has the job meanwhile: that claim is not taken from them for nothing, but a judgement ends the job.
    for (end, is_held, counted) in
        [(End::Error(RunCause::Link), true, ["1", "1"]), (End::Pass, false, ["1", "0"])]
    {
        let (server, mut plant, last) = put_back(2);
        let next = plant.claim(&worker("next")).unwrap().unwrap();
        assert_eq!(next.fence, 1);
        plant.take(&run_of(&last, 1, end)).unwrap();
        assert_eq!(plant.renew_claim(&next).unwrap(), is_held);
        plant.take(&run_of(&next, 2, End::Pass)).unwrap();
        assert_eq!(server.rows("SELECT nth FROM run ORDER BY id").concat(), counted);
        assert_eq!(server.rows("SELECT state FROM job"), [["done"]]);
        assert_well(&server);
    }
}

/// A plant that gets the run of a job's fifth claim after that claim has run out, others have asked for a job, and `meanwhile`
/// was done.
fn fifth_claim(end: End, meanwhile: impl Fn(&mut Plant, &str)) -> Server {
    let (server, mut plant, id) = with_a_job();
    let fifth = (0..5).map(|_| {
        run_out(&server);
        plant.claim(&worker("away")).unwrap().unwrap()
    });
    let fifth = fifth.last().unwrap();
    run_out(&server);
    assert_eq!(plant.claim(&worker("12")).unwrap(), None);
    assert_eq!(states(&server), [["dead", "5"]]);
    meanwhile(&mut plant, &id);
    // It is sent twice, like everything whose delivery is in doubt.
    for _ in 0..2 {
        plant.take(&run_of(&fifth, 1, end)).unwrap();
    }
    server
}

/// Asserts that the plant's tables are those that its records give.
fn assert_well(server: &Server) {
    assert_eq!(faults(server, "plant"), Vec::<String>::new());
}

#[test]
fn the_run_of_the_last_claim_counts_however_late_it_comes() {
    let done = "SELECT job.state, run.nth, job.said FROM job JOIN run ON run.id = job.run_id";
    let server = fifth_claim(End::Pass, |_, _| ());
    assert_eq!(server.rows(done), [["done", "1", "NULL"]]);
    assert_eq!(server.rows("SELECT runs, units, passed FROM day_count"), [["1", "1", "1"]]);
    assert_well(&server);
    // Meanwhile an engineer wants the job judged again; nobody has claimed it since.
    let retry = |plant: &mut Plant, id: &str| {
        assert!(plant.retry_job(id, engel(&reason("the cable is new"))).unwrap());
    };
    let server = fifth_claim(End::Fail(&["clock"]), retry);
    assert_eq!(server.rows(done), [["done", "1", "NULL"]]);
    assert_well(&server);
    // An ERROR leaves the job as it is, and is counted as an error.
    let server = fifth_claim(End::Error(RunCause::Link), retry);
    assert_eq!(states(&server), [["waiting", "0"]]);
    assert_eq!(server.rows("SELECT runs, errors FROM day_count"), [["1", "1"]]);
    assert_well(&server);
}

#[test]
fn what_a_claim_judged_before_a_person_cancelled_the_job_or_another_one_claimed_it_does_not_count() {
    let retry =
        |plant: &mut Plant, id: &str| assert!(plant.retry_job(id, engel(&reason("after all"))).unwrap());
    let again = |plant: &mut Plant, id: &str| {
        retry(plant, id);
        plant.claim(&worker("12")).unwrap().unwrap();
    };
    let cancelled = |plant: &mut Plant, id: &str| {
        retry(plant, id);
        assert!(plant.cancel_job(id, engel(&reason("a mistake"))).unwrap());
        retry(plant, id);
    };
    for end in [End::Pass, End::Error(RunCause::Link)] {
        let servers = [fifth_claim(end, again), fifth_claim(end, cancelled)];
        for (server, job) in servers.iter().zip([["claimed", "1"], ["waiting", "0"]]) {
            assert_eq!(
                (server.rows("SELECT nth FROM run"), states(server)),
                (vec![vec!["0".to_owned()]], vec![job.map(str::to_owned).to_vec()])
            );
            assert_eq!(server.rows("SELECT count(*) FROM day_count"), [["0"]]);
            assert_well(server);
        }
    }
}

#[test]
fn a_claim_judges_once() {
    let (server, mut plant, _) = with_a_job();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    for (number, end) in [(1, End::Fail(&["clock"])), (2, End::Pass)] {
        plant.take(&run_of(&claim, number, end)).unwrap();
    }
    assert_eq!(server.rows("SELECT nth FROM run ORDER BY id"), [["1"], ["0"]]);
    assert_well(&server);
}

#[test]
fn a_job_that_is_cancelled_is_lost_to_whoever_has_it() {
    let (server, mut plant, id) = with_a_job();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    assert!(plant.cancel_job(&id, engel(&reason("a mistake"))).unwrap());
    assert!(!plant.renew_claim(&claim).unwrap());
    plant.take(&run_of(&claim, 1, End::Pass)).unwrap();
    assert_eq!(server.rows("SELECT nth FROM run"), [["0"]]);
    assert_eq!(server.rows("SELECT state, said FROM job"), [["dead", "a mistake"]]);
    let told = server.rows(
        "SELECT act, subject = (SELECT id FROM job), detail FROM audit WHERE act LIKE '%job%' ORDER BY id",
    );
    assert_eq!(told, [["add job", "t", "1 of quick 1 for CAM-T mock"], ["cancel job", "t", "a mistake"]]);
}

#[test]
fn the_first_job_is_taken_that_a_station_can_judge() {
    let (_server, mut plant) = shared(2);
    plant.share(&board(7, "ulx3s"), "engel").unwrap();
    let own = halfrow_station::store::SharedBoard { station: "north".to_owned(), ..board(8, "rare") };
    plant.share(&own, "engel").unwrap();
    let (plan, needs) = (plan(), ["camera".to_owned()]);
    let [first, unit, ulx3s, rare] = [
        any(),
        Wanted::Serial("CAT00001".to_owned()),
        Wanted::Kind("ulx3s".to_owned()),
        Wanted::Kind("rare".to_owned()),
    ];
    let mut added = BTreeMap::new();
    let mut add = |name: &'static str, wanted, priority, needs| {
        let new = halfrow_station::store::NewJob { priority, needs, ..job(&plan, wanted) };
        let id = plant.add_jobs(&new, 1).unwrap().remove(0);
        added.insert(id, name);
    };
    add("any", &first, 0, &[]);
    add("unit", &unit, 5, &[]);
    add("camera", &ulx3s, 9, &needs);
    add("rare", &rare, 9, &[]);
    let mut take = |worker: &Worker| {
        let claim = plant.claim(worker).unwrap()?;
        Some((added[&claim.job], claim.lease.board))
    };
    let south = worker("south");
    let of = |name, board: &str| Some((name, board.to_owned()));
    assert_eq!(take(&Worker { plans: vec!["another".to_owned()], ..south.clone() }), None);
    assert_eq!(take(&south), of("unit", "shelf-1"));
    assert_eq!(take(&south), of("any", "shelf-0"));
    assert_eq!(take(&south), None);
    assert_eq!(
        take(&Worker { has: vec!["light".to_owned(), "camera".to_owned()], ..south }),
        of("camera", "shelf-7")
    );
    assert_eq!(take(&worker("north")), of("rare", "shelf-8"));
}
