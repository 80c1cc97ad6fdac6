//! The units that check a shift count nowhere at a plant either.

use halfrow_station::check::check_plant;
use halfrow_station::store::{Plant, Snapshot};

use super::sent::send;
use super::server::Server;
use crate::common::untold;
use crate::history::shift_units::{as_before, is_counted_right, made};

fn is_right(server: &Server) {
    let now = Snapshot::of_plant(Plant::connect(&server.address()).unwrap()).unwrap();
    let faults = check_plant(&now, &mut untold).unwrap().faults;
    assert!(faults.is_empty(), "{faults:?}");
    is_counted_right(&now);
}

#[test]
fn a_plant_counts_no_unit_that_checks_a_shift_even_if_an_earlier_program_did() {
    let server = Server::prepared();
    let (_made, all) = send(made(), server.address());
    assert_eq!((all.sent, all.failed), (12, 0));
    is_right(&server);
    server.client("plant").batch_execute(&as_before()).unwrap();
    assert_eq!(server.rows("SELECT sum(runs) FROM day_count"), [["11"]]);
    assert_eq!(Plant::prepare(&server.address()).unwrap(), 8);
    is_right(&server);
    assert_eq!(server.rows("SELECT sum(runs) FROM before_8.day_count"), [["11"]]);
}
