//! Text that PostgreSQL cannot hold.

use halfrow_station::history::runs::{Filter, page};
use halfrow_station::store::{Deed, Plant, Snapshot};

use super::sent::send;
use super::server::Server;
use super::tables::is_as;
use crate::common::reason;
use crate::history::made::{End, Made, Run};
use crate::history::released::history;

/// Boards, scanners and forms can send any character, even U+0000, which no text in PostgreSQL can contain (8.3).
#[test]
fn no_character_keeps_a_result_from_the_plant() {
    let server = Server::prepared();
    let mut made = Made::new();
    let run = Run { operator: "we\0ber".to_owned(), ..Run::of("S1", End::Fail(&["memory"])) };
    let run = made.run(&run);
    made.store.waive(&run, "engel", &reason("used\0as it is")).unwrap();
    made.store.note(Deed { operator: "weber", act: "scan", subject: "CA\0", detail: "" }).unwrap();
    let (made, all) = send(made, server.address());
    // A run, a waiver with its line in the audit, and a further line.
    assert_eq!((all.sent, all.failed), (4, 0));
    is_as(&server, &made);
    assert_eq!(server.rows("SELECT operator_id FROM run"), [["we\u{fffd}ber"]]);
    assert_eq!(server.rows("SELECT reason FROM waiver"), [["used\u{fffd}as it is"]]);
    let now = Snapshot::of_plant(Plant::connect(&server.address()).unwrap()).unwrap();
    let asked = Filter { serial: Some("S\0".to_owned()), ..Filter::default() };
    assert!(page(&now, &asked, None, 10).unwrap().runs.is_empty());
}

#[test]
fn what_a_plant_can_never_hold_waits_for_a_person() {
    let server = Server::prepared();
    server.never_holds("waiver");
    let (made, all) = send(history(), server.address());
    assert_eq!((all.sent, all.failed, all.is_away), (9, 1, false));
    let unsent = made.now().unsent().unwrap();
    let [dead] = &made.now().dead(&unsent).unwrap()[..] else { panic!("nothing waits") };
    assert!(dead.said.to_string().contains("no such character"), "{dead:?}");
}
