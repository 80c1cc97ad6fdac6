//! At a plant a lane's number says little, and evidence is elsewhere: pages name the station.

use halfrow_station::kept::prune;
use halfrow_station::store::SINK_OF_PLANT;

use super::pages::{served, text};
use super::sent::send;
use super::server::Server;
use crate::history::made::{End, Made, Run};

#[test]
fn a_run_at_the_plant_is_told_with_its_station_and_so_is_its_evidence() {
    let server = Server::prepared();
    let mut made = Made::new();
    let run = made.run(&Run { evidence: vec!["seen"], ..Run::of("S1", End::Fail(&["memory"])) });
    let (mut made, _) = send(made, server.address());
    let (_folder, serving) = served(&server);
    let browser = serving.here();
    let page = text(&browser, &format!("/runs/{run}"));
    assert!(page.contains("kept at station station 7") && !page.contains("removed"), "{page}");
    let unit = text(&browser, "/unit?serial=S1");
    let (_, story) = unit.split_once("<ol class=\"story\">").unwrap();
    assert!(story.contains("Station station 7 · Lane 1"), "{story}");
    made.store.sends_to(vec![SINK_OF_PLANT.to_owned()]).unwrap();
    assert_eq!(prune(&mut made.store, i64::MAX, "engel").unwrap().pieces, 1);
    let (_made, _) = send(made, server.address());
    let page = text(&browser, &format!("/runs/{run}"));
    assert!(page.contains("removed because it was old") && !page.contains("kept at station"), "{page}");
}
