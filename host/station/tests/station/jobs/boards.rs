//! Boards that are waited for, held and lost.

use std::io::{BufRead as _, BufReader, Lines};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};
use std::thread;

use halfrow_station::store::{Plant, SharedBoard, StoreError, Turn, Waiter, Wanted};
use serde_json::Value;

use super::claims::run_of;
use super::{add, board, job, plan, run_out, settings, shared, states, with_a_job, worker};
use crate::clocks::Clocks;
use crate::common::{Killed, did_in, engel, now_ms, program, reason, until};
use crate::history::made::End;
use crate::plant::server::Server;

fn waiter(name: &str) -> Waiter {
    Waiter::new("mock", name, "12", now_ms()).unwrap()
}

#[test]
fn who_waits_longest_is_the_next_and_a_job_comes_after_people() {
    let (server, mut plant, _) = with_a_job();
    let [first, second, third] = waiting([("first", "12"), ("second", "12"), ("third", "12")]);
    let Turn::Held(held) = plant.wait(&first).unwrap() else { panic!("it is free") };
    assert_eq!(plant.wait(&second).unwrap(), Turn::Waits { before: 0 });
    assert_eq!(plant.wait(&third).unwrap(), Turn::Waits { before: 1 });
    assert!(plant.renew(&held).unwrap());
    plant.give_back(&held).unwrap();
    assert_eq!(plant.wait(&third).unwrap(), Turn::Waits { before: 1 }, "another waits longer");
    assert_eq!(plant.claim(&worker("12")).unwrap(), None);
    // A waiter that does not ask again is forgotten.
    server.change("UPDATE waiter SET until_ms = 0 WHERE holder = '12 second'");
    let Turn::Held(held) = plant.wait(&third).unwrap() else { panic!("it is the third's turn") };
    assert_eq!((held.holder.as_str(), held.fence), ("12 third", 2));
    plant.give_back(&held).unwrap();
    assert!(plant.claim(&worker("12")).unwrap().is_some());
    assert_eq!(plant.wait(&Waiter::new("none", "first", "12", now_ms()).unwrap()).unwrap(), Turn::Never);
}

#[test]
fn a_job_for_any_board_of_a_kind_gets_none_of_another_kind() {
    let (_server, mut plant) = shared(1);
    assert!(plant.share(&board(1, "ulx3s"), "engel").unwrap());
    plant.add_jobs(&job(&plan(), &Wanted::Kind("ulx3s".to_owned())), 2).unwrap();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    assert_eq!(claim.lease.board, "shelf-1");
    assert_eq!(plant.claim(&worker("13")).unwrap(), None);
}

#[test]
fn a_job_that_is_done_is_neither_cancelled_nor_refused() {
    let (server, mut plant, id) = with_a_job();
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    plant.take(&run_of(&claim, 2, End::Pass)).unwrap();
    assert!(!plant.cancel_job(&id, engel(&reason("too late"))).unwrap());
    plant.refuse(&claim, "it passed already").unwrap();
    assert_eq!(states(&server), [["done", "1"]]);
}

/// The rows of both are ready before either is committed.
#[test]
fn of_two_people_who_share_a_unit_under_two_names_at_once_one_is_refused() {
    let server = Server::prepared();
    let mut client = server.client("plant");
    let wait = "CREATE FUNCTION wait() RETURNS trigger LANGUAGE plpgsql AS
            $$ BEGIN PERFORM pg_advisory_xact_lock(1); RETURN NEW; END $$;
        CREATE TRIGGER wait BEFORE INSERT ON board FOR EACH ROW EXECUTE FUNCTION wait();
        SELECT pg_advisory_lock(1)";
    client.batch_execute(wait).unwrap();
    let shared = thread::scope(|scope| {
        let share = |number: usize| {
            let one = SharedBoard { name: format!("shelf-{number}"), ..board(0, "mock") };
            let mut plant = Plant::connect(&server.address()).unwrap();
            scope.spawn(move || plant.share(&one, "engel").unwrap())
        };
        let both = [share(1), share(2)];
        let waiting = "SELECT 1 FROM pg_locks WHERE locktype = 'advisory' AND NOT granted";
        until("both to wait", || server.rows(waiting).len() == 2);
        client.batch_execute("SELECT pg_advisory_unlock(1)").unwrap();
        both.map(|one| one.join().unwrap())
    });
    assert_eq!(shared.iter().filter(|is_shared| **is_shared).count(), 1, "{shared:?}");
}

#[test]
fn a_board_that_was_taken_over_or_out_is_held_no_more() {
    let (server, mut plant) = shared(1);
    let Turn::Held(first) = plant.wait(&waiter("first")).unwrap() else { panic!("it is free") };
    run_out(&server);
    let Turn::Held(second) = plant.wait(&waiter("second")).unwrap() else { panic!("it is free again") };
    assert!(!plant.renew(&first).unwrap() && plant.renew(&second).unwrap());
    assert!(plant.take_out("shelf-0", engel(&reason("it smells"))).unwrap());
    assert!(!plant.renew(&second).unwrap());
    plant.give_back(&second).unwrap();
    assert_eq!(plant.wait(&waiter("third")).unwrap(), Turn::Never);
    assert!(plant.put_in("shelf-0", engel(&reason("it was cleaned"))).unwrap());
    assert!(matches!(plant.wait(&waiter("third")).unwrap(), Turn::Held(_)));
    assert!(!plant.put_in("shelf-9", engel(&reason("it was cleaned"))).unwrap());
    let told = server.rows("SELECT act, detail FROM audit WHERE act LIKE 'board %' ORDER BY id");
    assert_eq!(told, [["board out", "it smells"], ["board in", "it was cleaned"]]);
}

/// A plant with `shelf-0`, which every station reaches, and `shelf-1`, which only station A reaches.
fn one_for_all_and_one_for_a() -> (Server, Plant) {
    let (server, mut plant) = shared(1);
    let of_a = SharedBoard { station: "A".to_owned(), ..board(1, "mock") };
    assert!(plant.share(&of_a, "engel").unwrap());
    (server, plant)
}

/// Waiters, of whom the first has waited longest.
fn waiting<const N: usize>(who: [(&str, &str); N]) -> [Waiter; N] {
    let mut since_ms = now_ms();
    who.map(|(name, station)| {
        since_ms += 1;
        Waiter::new("mock", name, station, since_ms).unwrap()
    })
}

/// The board that the waiter gets, or how many are ahead of it.
fn got(plant: &mut Plant, waiter: &Waiter) -> Result<String, u32> {
    match plant.wait(waiter).unwrap() {
        Turn::Held(lease) => Ok(lease.board),
        Turn::Waits { before } => Err(before),
        Turn::Never => panic!("there are boards"),
    }
}

#[test]
fn who_does_not_reach_a_board_keeps_nobody_from_it() {
    let (_server, mut plant) = one_for_all_and_one_for_a();
    let [p, b, a, again] = waiting([("p", "B"), ("b", "B"), ("a", "A"), ("again", "A")]);
    assert_eq!(got(&mut plant, &p), Ok("shelf-0".to_owned()));
    assert_eq!(got(&mut plant, &b), Err(0));
    assert_eq!(got(&mut plant, &a), Ok("shelf-1".to_owned()), "B does not reach it");
    assert_eq!(got(&mut plant, &again), Err(1));
}

#[test]
fn who_has_a_board_of_their_own_leaves_the_one_that_all_reach() {
    let (_server, mut plant) = one_for_all_and_one_for_a();
    let [first, second, b] = waiting([("first", "A"), ("second", "A"), ("b", "B")]);
    let Turn::Held(held) = plant.wait(&first).unwrap() else { panic!("both are free") };
    assert_eq!(held.board, "shelf-1");
    assert_eq!(got(&mut plant, &b), Ok("shelf-0".to_owned()));
    assert_eq!(got(&mut plant, &second), Err(0));
    plant.give_back(&held).unwrap();
    assert_eq!(got(&mut plant, &second), Ok("shelf-1".to_owned()));
}

#[test]
fn what_those_in_front_are_to_get_is_left_to_them() {
    let (server, mut plant) = one_for_all_and_one_for_a();
    let [first, second, b] = waiting([("first", "A"), ("second", "A"), ("b", "B")]);
    for number in 0..2 {
        assert!(plant.take_out(&format!("shelf-{number}"), engel(&reason("it smells"))).unwrap());
    }
    // Boards that are out are offered to nobody, so both wait without one.
    for waiter in [&first, &second] {
        assert_eq!(plant.wait(waiter).unwrap(), Turn::Never);
        let wait = format!(
            "INSERT INTO waiter VALUES ('{}', 'mock', '{}', {})",
            waiter.id,
            waiter.holder,
            now_ms() + 600_000
        );
        server.change(&wait);
    }
    for number in 0..2 {
        assert!(plant.put_in(&format!("shelf-{number}"), engel(&reason("it was cleaned"))).unwrap());
    }
    assert_eq!(got(&mut plant, &b), Err(2), "one of their own, and the other one");
    assert_eq!(got(&mut plant, &second), Ok("shelf-0".to_owned()), "their own is the first's");
    assert_eq!(got(&mut plant, &first), Ok("shelf-1".to_owned()));
}

#[test]
fn a_job_is_judged_on_a_board_that_nobody_who_waits_reaches() {
    let (_server, mut plant) = one_for_all_and_one_for_a();
    add(&mut plant, 2);
    let [p, b] = waiting([("p", "B"), ("b", "B")]);
    let Turn::Held(held) = plant.wait(&p).unwrap() else { panic!("it is free") };
    assert_eq!(got(&mut plant, &b), Err(0));
    plant.give_back(&held).unwrap();
    let claim = plant.claim(&worker("A")).unwrap().unwrap();
    assert_eq!(claim.lease.board, "shelf-1", "a person waits for the other one");
    assert_eq!(plant.claim(&worker("A")).unwrap(), None);
}

#[test]
fn a_board_whose_holder_vanished_can_be_shared_otherwise() {
    let (server, mut plant) = shared(1);
    let Turn::Held(held) = plant.wait(&waiter("first")).unwrap() else { panic!("it is free") };
    let other = SharedBoard { target: "tcp:shelf:5000".to_owned(), ..board(0, "other") };
    assert!(!plant.share(&other, "engel").unwrap(), "somebody has it");
    run_out(&server);
    assert!(plant.share(&other, "engel").unwrap());
    assert_eq!(server.rows("SELECT kind, target, holder FROM board"), [["other", "tcp:shelf:5000", "NULL"]]);
    assert!(!plant.renew(&held).unwrap(), "it was another board");
}

/// A board with two names would be given to two holders.
#[test]
fn a_unit_is_shared_under_one_name() {
    let (server, mut plant) = shared(1);
    let again = SharedBoard { name: "shelf-9".to_owned(), ..board(0, "mock") };
    assert!(!plant.share(&again, "engel").unwrap());
    assert_eq!(server.rows("SELECT name FROM board"), [["shelf-0"]]);
    let unlabelled = |name: &str| {
        let (product, serial) = (String::new(), String::new());
        SharedBoard { name: name.to_owned(), product, serial, ..board(0, "mock") }
    };
    for name in ["shelf-1", "shelf-2", "shelf-0"] {
        assert!(plant.share(&unlabelled(name), "engel").unwrap(), "{name}");
    }
    assert!(plant.share(&again, "engel").unwrap(), "the other one has no number any more");
    let folder = tempfile::tempdir().unwrap();
    settings(&server, folder.path(), "12");
    let share = ["board", "share", "shelf-3", "--kind", "mock", "--board", "mock", "--product", "CAM-T"];
    let unit = ["--serial", "CAT00000", "--operator", "engel"];
    let did = did_in(folder.path(), &[&share[..], &unit].concat());
    assert_eq!(did.code, Some(2));
    assert!(did.complained.contains("CAT00000 is shared as the board shelf-9 already"), "{did:?}");
}

/// `halfrow-station board hold mock`
struct Hold {
    process: Killed,
    stdin: Option<ChildStdin>,
    told: Lines<BufReader<ChildStdout>>,
    _folder: tempfile::TempDir,
}

impl Hold {
    fn start(server: &Server, name: &str) -> Self {
        Self::by(Command::new(program()), server, name)
    }

    /// The same by this call of the program.
    fn by(mut command: Command, server: &Server, name: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = settings(server, folder.path(), name);
        command.args(["board", "hold", "mock", "--settings"]).arg(path);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = Killed(command.spawn().unwrap());
        let told = BufReader::new(process.stdout.take().unwrap()).lines();
        Self { stdin: process.stdin.take(), told, process, _folder: folder }
    }

    /// The next message that has this key.
    fn tells(&mut self, key: &str) -> Value {
        let lines = self.told.by_ref().map(|line| serde_json::from_str::<Value>(&line.unwrap()).unwrap());
        lines.map(|mut told| told[key].take()).find(|told| !told.is_null()).unwrap()
    }
}

#[test]
fn a_board_is_held_until_stdin_ends_and_the_next_one_gets_it() {
    let (server, mut plant) = shared(1);
    let mut first = Hold::start(&server, "12");
    let held = first.tells("held");
    assert_eq!((held["board"].as_str(), held["target"].as_str()), (Some("shelf-0"), Some("mock")));
    let mut second = Hold::start(&server, "13");
    assert_eq!(second.tells("waits")["before"], 0);
    let mut third = Hold::start(&server, "14");
    assert_eq!(third.tells("waits")["before"], 1);
    drop(first.stdin.take());
    assert!(first.process.wait().unwrap().success());
    assert_eq!(second.tells("held")["fence"], 2);
    // Whoever started the second was killed, which ends its stdin; and it was killed itself, so only its lease ends.
    second.process.kill().unwrap();
    let mut client = server.client("plant");
    assert_eq!(client.execute("UPDATE board SET until_ms = 0", &[]).unwrap(), 1);
    assert_eq!(third.tells("held")["fence"], 3);
    assert!(plant.take_out("shelf-0", engel(&reason("it smells"))).unwrap());
    // The holder checks its lease every ten seconds.
    assert!(third.tells("lost")["said"].as_str().unwrap().contains("not ours any more"));
    assert_eq!(third.process.wait().unwrap().code(), Some(3));
    drop(Plant::connect(&server.address()).unwrap());
}

/// A computer whose clock is slow would be served before all others for ever, and one whose clock is fast after them.
#[test]
fn who_came_first_is_told_by_the_plant_s_clock_and_not_by_theirs() {
    let (server, _plant) = shared(1);
    let mut first = Hold::start(&server, "12");
    first.tells("held");
    let place = tempfile::tempdir().unwrap();
    let clocks = Clocks::in_folder(place.path());
    let mut waiting = Vec::new();
    for (name, ahead, before) in [("13", 600, 0), ("14", -600, 1), ("15", 0, 2)] {
        clocks.ahead(ahead, 0);
        let mut command = Command::new(program());
        clocks.of(&mut command);
        let mut hold = Hold::by(command, &server, name);
        assert_eq!(hold.tells("waits")["before"], before, "{name}");
        waiting.push(hold);
    }
}

/// Its place in the queue is kept for ten seconds.
#[test]
fn whoever_waits_for_a_board_goes_on_when_the_plant_was_away() {
    let (server, _plant) = shared(1);
    let mut first = Hold::start(&server, "12");
    first.tells("held");
    let mut second = Hold::start(&server, "13");
    second.tells("waits");
    // That of the second, which connected last.
    let newest = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity
        WHERE application_name = 'halfrow-station' AND backend_start = (SELECT max(backend_start)
            FROM pg_stat_activity WHERE application_name = 'halfrow-station')";
    assert_eq!(server.rows(newest).len(), 1);
    drop(first.stdin.take());
    assert!(first.process.wait().unwrap().success());
    assert_eq!(second.tells("held")["fence"], 2);
}

/// It would claim the same job until that is dead, since it cannot renew its lease over a new connection.
#[test]
fn a_program_that_is_older_than_the_tables_takes_no_job_and_no_board_over_the_connection_that_it_has() {
    let (server, mut plant, id) = with_a_job();
    let upgraded = || server.change("INSERT INTO schema_version VALUES (99, 'x', 1)");
    upgraded();
    let refused = [
        plant.claim(&worker("12")).unwrap_err(),
        plant.wait(&waiter("somebody")).unwrap_err(),
        plant.cancel_job(&id, engel(&reason("a mistake"))).unwrap_err(),
    ];
    for refused in refused {
        assert!(matches!(refused, StoreError::Newer { found: 99, .. }), "{refused:?}");
    }
    assert_eq!(states(&server), [["waiting", "0"]]);
    server.change("DELETE FROM schema_version WHERE n = 99");
    let claim = plant.claim(&worker("12")).unwrap().unwrap();
    upgraded();
    // What it holds it keeps, and gives back.
    assert!(plant.renew_claim(&claim).unwrap());
    plant.decline(&claim, None).unwrap();
    assert_eq!(states(&server), [["waiting", "0"]]);
}
