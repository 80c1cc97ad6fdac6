//! What arrives at the plant is what the station has.

use halfrow_station::outbox::{PlantSink, Round, Standing, round};
use halfrow_station::store::{
    Introduction, LastTold, Plant, PlantAddress, SINK_OF_PLANT, SharedStore, Store,
};

use super::rights::as_station;
use super::server::Server;
use super::tables::is_as;
use crate::history::made::{End, Made, Run};
use crate::history::released::history;

/// Sends everything that is due, until nothing is.
pub(crate) fn send(made: Made, address: PlantAddress) -> (Made, Round) {
    send_as("station 7", made, address)
}

/// Like [`send`], from a station of this name.
pub(crate) fn send_as(name: &str, made: Made, address: PlantAddress) -> (Made, Round) {
    let (folder, mut store) = made.parts();
    store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
    let mut sink = sink(name, &mut store, address);
    let store = SharedStore::new(store);
    let mut all = Round::default();
    loop {
        let Round { sent, failed, is_away } = round(&store, &mut sink, &mut Standing::default()).unwrap();
        all = Round { sent: all.sent + sent, failed: all.failed + failed, is_away };
        if is_away || sent == 0 {
            break;
        }
    }
    drop(store);
    (Made::at(folder), all)
}

/// The plant at this address, as the sink of a station of this name.
pub(super) fn sink(name: &str, store: &mut Store, address: PlantAddress) -> PlantSink {
    PlantSink::new(address, introduction(name, store.origin().unwrap()), store.folder().clone())
}

/// What a station of this name says of itself.
pub(crate) fn introduction(name: &str, origin: String) -> Introduction {
    let plans = "CAM-T final 1\nCAM-T intake 1".to_owned();
    let (name, program, told) = (name.to_owned(), "halfrow 0".to_owned(), LastTold::default());
    Introduction { name, origin, program, plans, unsent: 0, dead: 0, told }
}

/// Makes the station forget what it has sent.
pub(super) fn forget(made: &Made) {
    assert!(made.change("DELETE FROM outbox") > 0);
}

#[test]
fn all_that_a_station_keeps_comes_to_the_plant_once() {
    let server = Server::prepared();
    let address = PlantAddress::new(&as_station(&server), None, None).unwrap();
    server.change("REVOKE USAGE ON SCHEMA public FROM PUBLIC, station");
    let shut = anyhow::Error::from(Plant::connect(&address).unwrap_err());
    assert!(format!("{shut:#}").contains("grant it USAGE on the schema"), "{shut:#}");
    server.change("GRANT USAGE ON SCHEMA public TO station");
    let (made, all) = send(history(), address);
    // Seven runs, a waiver with its line in the audit, and a rebinding.
    assert_eq!(all, Round { sent: 10, failed: 0, is_away: false });
    is_as(&server, &made);
    // What comes later is sent on its own.
    let (mut made, all) = send(made, server.address());
    assert_eq!(all, Round::default());
    made.run(&Run { lane: "3".to_owned(), ..Run::of("S2", End::Pass).at_hour(30) });
    let (made, all) = send(made, server.address());
    assert_eq!(all.sent, 1);
    is_as(&server, &made);
    // A station that has forgotten what it sent sends it again, which changes nothing.
    forget(&made);
    let (made, all) = send(made, server.address());
    assert_eq!(all.sent, 11);
    is_as(&server, &made);
    assert!(made.now().unsent().unwrap().is_empty());
}
