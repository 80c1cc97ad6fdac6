//! Connections that are cut in front of a COMMIT or behind it, and a server that is killed: nothing is lost, and nothing is there
//! twice.

use std::io::{Read as _, Write as _};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use halfrow_station::store::PlantAddress;

use super::sent::send;
use super::server::Server;
use super::tables::is_as;
use crate::history::released::history;

/// Where a connection is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cut {
    /// The server never sees the COMMIT.
    Before,
    /// It carries it out, and nobody hears of it.
    Behind,
    /// The server never sees it, and the station hears that it was carried out.
    Pretended,
}

/// What a server answers to a COMMIT: CommandComplete, and ReadyForQuery outside of a transaction (PostgreSQL, 55.7).
const COMMITTED: &[u8] = b"C\0\0\0\x0bCOMMIT\0Z\0\0\0\x05I";

/// A way to the server that is cut at its `number`-th COMMIT, once. Returns its port.
fn way(to: u16, cut: Cut, number: usize) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let commits = Arc::new(AtomicUsize::new(0));
    thread::spawn(move || {
        for client in listener.incoming() {
            let (client, commits) = (client.unwrap(), Arc::clone(&commits));
            thread::spawn(move || {
                let server = TcpStream::connect(("127.0.0.1", to)).unwrap();
                let (from, back) = (server.try_clone().unwrap(), client.try_clone().unwrap());
                thread::spawn(move || carried(from, &back, &mut |_| true));
                let mut asked = client.try_clone().unwrap();
                let watch = |bytes: &[u8]| {
                    if !bytes.windows(6).any(|word| word == b"COMMIT")
                        || commits.fetch_add(1, Ordering::SeqCst) != number
                    {
                        return true;
                    }
                    if cut == Cut::Behind {
                        let _ = client.shutdown(Shutdown::Both);
                        (&server).write_all(bytes).unwrap();
                        // It has done it when it answers that it waits for more.
                        thread::sleep(std::time::Duration::from_millis(50));
                    }
                    if cut == Cut::Pretended {
                        (&client).write_all(COMMITTED).unwrap();
                    }
                    let _ = server.shutdown(Shutdown::Both);
                    false
                };
                while let Some(bytes) = some(&mut asked) {
                    if !watch(&bytes) || (&server).write_all(&bytes).is_err() {
                        break;
                    }
                }
                let _ = client.shutdown(Shutdown::Both);
            });
        }
    });
    port
}

fn some(from: &mut TcpStream) -> Option<Vec<u8>> {
    let mut bytes = vec![0; 65_536];
    let read = from.read(&mut bytes).ok().filter(|read| *read > 0)?;
    bytes.truncate(read);
    Some(bytes)
}

fn carried(mut from: TcpStream, mut to: &TcpStream, watch: &mut dyn FnMut(&[u8]) -> bool) {
    while let Some(bytes) = some(&mut from) {
        if !watch(&bytes) || to.write_all(&bytes).is_err() {
            break;
        }
    }
    let _ = to.shutdown(Shutdown::Both);
}

#[test]
fn a_connection_that_is_cut_at_some_commits_loses_nothing_and_doubles_nothing() {
    cut_at([0, 3, 7]);
}

#[test]
#[ignore = "for scripts/soak"]
fn a_connection_that_is_cut_at_any_commit_loses_nothing_and_doubles_nothing() {
    cut_at(0..8);
}

/// Cuts connections in every way at each of these commits.
fn cut_at(numbers: impl IntoIterator<Item = usize>) {
    let server = Server::prepared();
    for number in numbers {
        for cut in [Cut::Before, Cut::Behind, Cut::Pretended] {
            server
                .client("plant")
                .batch_execute("TRUNCATE plan, unit, run, record, audit, station CASCADE")
                .unwrap();
            let url = format!("postgres://postgres@127.0.0.1:{}/plant", way(server.port(), cut, number));
            let address = PlantAddress::new(&url, None, None).unwrap();
            let (made, first) = send(history(), address.clone());
            assert!(first.is_away && first.failed == 1, "{cut:?} {number}: {first:?}");
            // What the station holds to be unsent is there if, and only if, the server had heard of the COMMIT.
            let [unsent] = &made.folder().unsent().unwrap()[..] else { panic!("nothing was cut") };
            let there = server
                .rows("SELECT id FROM run UNION ALL SELECT id FROM audit UNION ALL SELECT id FROM waiver");
            let surplus = usize::from(cut == Cut::Behind);
            assert_eq!(there.len() + unsent.entries as usize, 10 + surplus, "{cut:?} {number}");
            due(&made);
            let (made, rest) = send(made, address);
            assert_eq!(first.sent + rest.sent, 10, "{cut:?} {number}");
            is_as(&server, &made);
        }
    }
}

/// All that waits for a later try is due now.
pub(super) fn due(made: &crate::history::made::Made) {
    let database = rusqlite::Connection::open(made.folder().database()).unwrap();
    database.execute("UPDATE outbox SET next_ms = 0", []).unwrap();
}

#[test]
fn a_server_that_is_killed_and_comes_back_gets_all() {
    let mut server = Server::prepared();
    server.kill();
    let (made, vain) = send(history(), server.address());
    assert_eq!((vain.sent, vain.failed, vain.is_away), (0, 1, true));
    let [unsent] = &made.folder().unsent().unwrap()[..] else { panic!("all was sent") };
    assert_eq!((unsent.entries, unsent.dead), (10, 0));
    assert!(unsent.said.as_ref().unwrap().contains("refuses a connection"), "{unsent:?}");
    server.again();
    due(&made);
    let (made, all) = send(made, server.address());
    assert_eq!((all.sent, all.failed), (10, 0));
    is_as(&server, &made);
    // Connections that are open when it is killed are not taken for anything.
    server.kill();
    server.again();
    let (made, none) = send(made, server.address());
    assert_eq!(none.sent + none.failed, 0);
    is_as(&server, &made);
}
