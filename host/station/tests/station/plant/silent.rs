//! A plant that accepts what it is sent, and does not answer.

use std::fs;
use std::io::{Read as _, Write as _};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::process::Stdio;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use halfrow_station::outbox::{Standing, round};
use halfrow_station::store::{PlantAddress, PlantLink, SINK_OF_PLANT, SharedStore, Turn, Waiter};
use halfrow_station::work::{Held, Holding};

use nix::sys::signal::Signal;

use super::sent::sink;
use super::server::Server;
use crate::common::{Killed, command, folder, now_ms, signal, until, until_found};
use crate::history::made::{End, Made, Run};
use crate::jobs::{settings_of, shared};

/// A relay in front of a server.
struct Way {
    port: u16,
    is_silent: Arc<AtomicBool>,
    /// Over how many connections something was sent while it was silent.
    swallowed: Arc<AtomicUsize>,
}

impl Way {
    /// A relay to the server on the port `to`.
    fn to(to: u16) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let is_silent = Arc::new(AtomicBool::new(false));
        let swallowed = Arc::new(AtomicUsize::new(0));
        let (told, notes) = (Arc::clone(&is_silent), Arc::clone(&swallowed));
        thread::spawn(move || {
            for client in listener.incoming() {
                let (client, server) = (client.unwrap(), TcpStream::connect(("127.0.0.1", to)).unwrap());
                for (from, to) in [(&client, &server), (&server, &client)] {
                    let (from, to) = (from.try_clone().unwrap(), to.try_clone().unwrap());
                    let (is_silent, swallowed) = (Arc::clone(&told), Arc::clone(&notes));
                    thread::spawn(move || carry(from, to, &is_silent, &swallowed));
                }
            }
        });
        Self { port, is_silent, swallowed }
    }

    /// The address of the server by this relay.
    fn url(&self) -> String {
        format!("postgres://postgres@127.0.0.1:{}/plant", self.port)
    }

    fn is_silent(&self, is_silent: bool) {
        self.is_silent.store(is_silent, Ordering::SeqCst);
    }
}

/// Forwards bytes until it is to be silent; then this connection stays as it is for ever.
fn carry(mut from: TcpStream, mut to: TcpStream, is_silent: &AtomicBool, swallowed: &AtomicUsize) {
    let mut bytes = vec![0; 65_536];
    while let Ok(read @ 1..) = from.read(&mut bytes) {
        if is_silent.load(Ordering::SeqCst) {
            swallowed.fetch_add(1, Ordering::SeqCst);
            loop {
                thread::park();
            }
        }
        if to.write_all(&bytes[..read]).is_err() {
            break;
        }
    }
    let _ = to.shutdown(Shutdown::Both);
}

#[test]
fn a_plant_that_answers_nothing_is_away_and_has_all_once_it_answers_again() {
    let server = Server::prepared();
    let way = Way::to(server.port());
    let mut made = Made::new();
    made.store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
    for (number, serial) in (1..).zip(["S1", "S2"]) {
        made.numbered(number, &Run::of(serial, End::Pass));
    }
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    let one_waits =
        "UPDATE outbox SET next_ms = (unixepoch() + 240) * 1000 WHERE subject = (SELECT max(id) FROM run)";
    assert_eq!(database.execute(one_waits, []).unwrap(), 1);
    let due = || database.execute("UPDATE outbox SET next_ms = 0 WHERE done_ms IS NULL", []).unwrap();
    let address = PlantAddress::new(&way.url(), None, None).unwrap();
    let mut sink = sink("station 7", &mut made.store, address);
    let (_folder, store) = made.parts();
    let store = SharedStore::new(store);
    assert_eq!(round(&store, &mut sink, &mut Standing::default()).unwrap().sent, 1);
    // Over a connection that exists, and over a new one.
    way.is_silent(true);
    for _ in 0..2 {
        assert_eq!(due(), 1);
        let vain = round(&store, &mut sink, &mut Standing::default()).unwrap();
        assert_eq!((vain.sent, vain.failed, vain.is_away), (0, 1, true));
        let said: String = database.query_row("SELECT max(said) FROM outbox", [], |row| row.get(0)).unwrap();
        assert!(said.contains("has said nothing for 20 s"), "{said}");
    }
    way.is_silent(false);
    assert_eq!(due(), 1);
    assert_eq!(round(&store, &mut sink, &mut Standing::default()).unwrap().sent, 1);
    assert_eq!(server.rows("SELECT count(*) FROM run"), [["2"]]);
}

/// As when a server fails over: nothing comes over the connection that was, and the next one works at once.
#[test]
fn a_board_is_still_held_when_the_connection_that_renews_it_is_dead() {
    let (server, mut plant) = shared(1);
    let way = Way::to(server.port());
    let link = PlantLink::new(PlantAddress::new(&way.url(), None, None).unwrap());
    let waiter = Waiter::new("mock", "weber", "12", now_ms()).unwrap();
    let turn = link.ask(|plant| plant.wait(&waiter)).unwrap();
    let Turn::Held(lease) = turn else { panic!("it is free") };
    let holding = Holding::begin(link, Held::Board(lease.clone()));
    way.is_silent(true);
    until("a renewal", || way.swallowed.load(Ordering::SeqCst) > 0);
    way.is_silent(false);
    let renewed_until = || server.rows("SELECT until_ms FROM board")[0][0].parse::<i64>().unwrap();
    let before = renewed_until();
    until("the next renewal", || renewed_until() > before || holding.is_lost());
    assert_eq!(holding.lost(), None);
    assert!(plant.renew(&lease).unwrap());
    holding.end();
    assert!(!plant.renew(&lease).unwrap(), "it was given back");
}

/// Otherwise each of those that are kept would fail a question of its own, perhaps hours later.
#[test]
fn a_restart_of_the_plant_fails_one_question_however_many_connections_were_kept() {
    let server = Server::prepared();
    let link = PlantLink::new(server.address());
    let asked = |link: &PlantLink| link.ask(|plant| plant.counts("none"));
    // The second question comes while the first is under way.
    assert_eq!(link.ask(|_| asked(&link)).unwrap(), None);
    let all = "FROM pg_stat_activity WHERE application_name = 'halfrow-station'";
    until("both connections alone", || server.rows(&format!("SELECT count(*) {all}")) == [["2"]]);
    server.rows(&format!("SELECT pg_terminate_backend(pid, 60000) {all}"));
    assert!(asked(&link).unwrap_err().is_away());
    assert_eq!(asked(&link).unwrap(), None);
}

/// How many threads of a station at work are hands, beside its first thread.
fn hands(process: u32) -> usize {
    let threads = fs::read_dir(format!("/proc/{process}/task")).unwrap();
    let names = threads.map(|thread| fs::read_to_string(thread.unwrap().path().join("comm")));
    names.filter(|name| name.as_ref().is_ok_and(|name| name.starts_with("hand "))).count()
}

/// One after the other, they would all have to wait for an answer before the station could end.
#[test]
fn the_hands_of_a_station_do_not_wait_for_each_other_s_answers() {
    const HANDS: usize = 16;
    let (server, _plant) = shared(0);
    let way = Way::to(server.port());
    let folder = folder();
    let path = settings_of(&way.url(), folder.path(), "12");
    fs::write(&path, fs::read_to_string(&path).unwrap() + &format!("at_once = {HANDS}\n")).unwrap();
    let mut worker = Killed(command(folder.path(), &["work"]).stderr(Stdio::null()).spawn().unwrap());
    // Before that, one connection asks until the plant knows the station.
    until("its hands", || hands(worker.id()) == HANDS - 1);
    way.is_silent(true);
    until("a question of each", || way.swallowed.load(Ordering::SeqCst) >= HANDS);
    signal(worker.id(), Signal::SIGTERM);
    let ended = until_found("its end", || worker.try_wait().unwrap().ok_or("at work"));
    assert_eq!(ended.code(), Some(143));
}
