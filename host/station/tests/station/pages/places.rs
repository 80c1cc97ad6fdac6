//! How many connections there are, and who has them.

use crate::pages::station::Station;

/// A program on the station's own computer that opens connection after connection, and closes none.
#[test]
fn whoever_has_taken_many_connections_keeps_nobody_from_the_pages() {
    for (station, has_proxy) in [(Station::private(1), false), (Station::public(1), true)] {
        let serving = station.serve();
        let here = if has_proxy { serving.operator() } else { serving.here() };
        let mut streams = Vec::new();
        for _ in 0..100 {
            let mut news = here.get("/live").lines();
            assert!(news.next().unwrap().contains("200"));
            streams.push(news);
            assert_eq!(here.get("/").send().status, 200, "behind {} streams of news", streams.len());
        }
    }
}
