//! A station and a copy of its folder, both at work.

use halfrow_station::store::{Plant, PlantError};

use super::clocks::FAST;
use super::sent::introduction;
use super::server::Server;
use crate::common::until;

/// docs/station-setup.md: the plant says so to the one that it heard of before.
#[test]
fn a_copy_that_is_at_work_beside_its_station_is_noticed() {
    let server = Server::prepared();
    let mut plant = Plant::connect(&server.address()).unwrap();
    let [first, copy] = [(); 2].map(|()| introduction("12", "0".repeat(36)));
    let tick = |plant: &mut Plant| {
        let now = plant.now_ms().unwrap();
        until("the plant's next millisecond", || plant.now_ms().unwrap() > now);
    };
    plant.see(&first).unwrap();
    plant.see(&first.clone()).unwrap();
    tick(&mut plant);
    // A restart looks just like this.
    plant.see(&copy).unwrap();
    for _ in 0..2 {
        let twice = plant.see(&first).unwrap_err();
        assert!(matches!(&twice, PlantError::OtherStation { name } if name == "12"), "{twice:?}");
        tick(&mut plant);
        plant.see(&copy).unwrap();
    }
    // The copy was ended, and not heard of for two minutes.
    server.change(FAST);
    Plant::connect(&server.address()).unwrap().see(&first).unwrap();
}
