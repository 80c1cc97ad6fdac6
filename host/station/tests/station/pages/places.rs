//! How many connections there are, and who has them.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};

use super::http::connected;
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

/// Whoever has half a form has been promised nothing. It takes no login to begin one.
#[test]
fn forms_that_are_begun_keep_nobody_from_the_pages_and_are_answered_where_there_is_room() {
    for (station, has_proxy) in [(Station::private(1), false), (Station::public(1), true)] {
        let serving = station.serve();
        let here = if has_proxy { serving.operator() } else { serving.here() };
        let form = here.post("/language", &[("language", "de")]).text();
        let (first, rest) = form.split_at(form.len() - 9);
        let begun = || {
            let mut stream = connected(serving.port);
            stream.write_all(first.as_bytes()).unwrap();
            stream
        };
        let mut slow = begun();
        assert_eq!(here.get("/").send().status, 200);
        slow.write_all(rest.as_bytes()).unwrap();
        let mut answer = String::new();
        slow.read_to_string(&mut answer).unwrap();
        assert!(answer.contains(" 303 "), "{answer}");
        let mut news = here.get("/live").lines();
        assert!(news.next().unwrap().contains("200"));
        let mut streams = Vec::new();
        for _ in 0..100 {
            streams.push(begun());
            assert_eq!(here.get("/").send().status, 200, "behind {} forms", streams.len());
        }
        assert!(news.any(|line| line.starts_with("event: beat")), "news go on");
    }
}

/// Behind a proxy all connections are of one address, whoever has opened them.
#[test]
fn a_form_that_has_just_begun_does_not_give_way_to_connections_on_which_nothing_comes() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator();
    // docs/station-lanes.md: there is room for 64.
    let mut idle: Vec<_> = (0..70).map(|_| connected(serving.port)).collect();
    let form = operator.post("/language", &[("language", "de")]).with("expect", "100-continue").text();
    let (head, rest) = form.split_at(form.find("\r\n\r\n").unwrap() + 4);
    let mut slow = BufReader::new(connected(serving.port));
    slow.get_mut().write_all(head.as_bytes()).unwrap();
    let mut line = String::new();
    slow.read_line(&mut line).unwrap();
    // RFC 9110, section 10.1.1: from here on the form is awaited.
    assert!(line.contains(" 100 "), "{line}");
    for late in 0..10 {
        idle.push(connected(serving.port));
        assert_eq!(operator.get("/").send().status, 200, "{late}");
    }
    slow.get_mut().write_all(rest.as_bytes()).unwrap();
    let mut answer = String::new();
    slow.read_to_string(&mut answer).unwrap();
    assert!(answer.contains(" 303 "), "{answer}");
}
