//! Connections that are cut before or after a COMMIT, and a server that is killed: nothing is lost, and nothing is doubled.

use std::sync::atomic::{AtomicUsize, Ordering};

use halfrow_station::store::PlantAddress;

use super::sent::{forget, send};
use super::server::Server;
use super::tables::is_as;
use super::way::{Cut, way};
use crate::common::{query, until};
use crate::history::released::history;

#[test]
fn a_connection_that_is_cut_at_some_commits_loses_nothing_and_doubles_nothing() {
    // The last three are a waiver, the line about it and a rebinding, in an order that is drawn.
    cut_at([0, 3, 7, 8, 9]);
}

#[test]
#[ignore = "for scripts/soak"]
fn a_connection_that_is_cut_at_any_commit_loses_nothing_and_doubles_nothing() {
    cut_at(0..10);
}

/// Cuts connections in every way at each of these COMMITs.
fn cut_at(numbers: impl IntoIterator<Item = usize>) {
    let server = Server::prepared();
    for number in numbers {
        for cut in [Cut::Before, Cut::After, Cut::Pretended] {
            empty(&server);
            let commits = AtomicUsize::new(0);
            let once = move |_| (commits.fetch_add(1, Ordering::SeqCst) == number).then_some(cut);
            let url = format!("postgres://postgres@127.0.0.1:{}/plant", way(server.port(), once));
            let address = PlantAddress::new(&url, None, None).unwrap();
            let (made, first) = send(history(), address.clone());
            assert!(first.is_away && first.failed == 1, "{cut:?} {number}: {first:?}");
            // What the station regards as unsent is at the plant if, and only if, the server got the COMMIT.
            let [unsent] = &made.now().unsent().unwrap()[..] else { panic!("nothing was cut") };
            let surplus = usize::from(cut == Cut::After);
            until(&format!("what was sent, {cut:?} {number}"), || {
                let there = server.rows(
                    "SELECT id FROM run UNION ALL SELECT id FROM audit UNION ALL SELECT id FROM waiver",
                );
                there.len() + unsent.entries as usize == 10 + surplus
            });
            due(&made);
            let (made, rest) = send(made, address);
            assert_eq!(first.sent + rest.sent, 10, "{cut:?} {number}");
            is_as(&server, &made);
        }
    }
}

/// Deletes all that the plant has.
fn empty(server: &Server) {
    let all = "TRUNCATE plan, unit, run, record, audit, station CASCADE";
    server.change(all);
}

/// Makes everything that waits for a later try due now.
pub(super) fn due(made: &crate::history::made::Made) {
    made.change("UPDATE outbox SET next_ms = 0");
}

/// The server carries out the COMMIT, and has entered nothing in one of its tables.
#[test]
fn what_the_plant_has_not_kept_counts_as_unsent() {
    let server = Server::prepared();
    let mut made = history();
    for (table, kind, count) in
        [("run", "run", 7), ("record", "run", 7), ("waiver", "waiver", 1), ("audit", "audit", 2)]
    {
        empty(&server);
        server.loses(table);
        let (sending, first) = send(made, server.address());
        let lost = "SELECT kind FROM outbox WHERE done_ms IS NULL AND said LIKE '%has not kept%'";
        assert_eq!(query(sending.as_ref(), lost), vec![kind; count], "{table}: {first:?}");
        server.loses_nothing(table);
        due(&sending);
        let (sent, rest) = send(sending, server.address());
        assert_eq!((first.sent + rest.sent, rest.failed), (10, 0), "{table}");
        is_as(&server, &sent);
        forget(&sent);
        made = sent;
    }
}

#[test]
fn a_server_that_is_killed_and_comes_back_gets_all() {
    let mut server = Server::prepared();
    server.kill();
    let (made, vain) = send(history(), server.address());
    assert_eq!((vain.sent, vain.failed, vain.is_away), (0, 1, true));
    let [unsent] = &made.now().unsent().unwrap()[..] else { panic!("all was sent") };
    assert_eq!((unsent.entries, unsent.dead), (10, 0));
    assert!(unsent.said.as_ref().unwrap().to_string().contains("refuses a connection"), "{unsent:?}");
    server.again();
    due(&made);
    let (made, all) = send(made, server.address());
    assert_eq!((all.sent, all.failed), (10, 0));
    is_as(&server, &made);
    // Connections that were open when the server was killed are not mistaken for live ones.
    server.kill();
    server.again();
    let (made, none) = send(made, server.address());
    assert_eq!(none.sent + none.failed, 0);
    is_as(&server, &made);
}
