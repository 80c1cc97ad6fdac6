//! A plant that has lost what it had: its stations have it still.

use super::sent::{forget, send};
use super::server::Server;
use super::tables::is_as;
use crate::history::released::history;

#[test]
fn a_record_that_the_plant_has_lost_comes_again_with_its_run() {
    let server = Server::prepared();
    let (made, _) = send(history(), server.address());
    server.client("plant").batch_execute("DELETE FROM record").unwrap();
    forget(&made);
    let (made, all) = send(made, server.address());
    assert_eq!((all.sent, all.failed), (10, 0));
    is_as(&server, &made);
}
