//! Requests that arrive slowly, or not at all.

use std::fs;
use std::io::{Read as _, Write as _};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use super::http::connected;
use super::station::{SERIALS, Station};
use crate::common::held_up;

/// What is answered to the first part of `text`, and to `rest` after it.
fn answered(port: u16, first: &str, rest: &str) -> String {
    let mut stream = connected(port);
    stream.write_all(first.as_bytes()).unwrap();
    stream.write_all(rest.as_bytes()).unwrap();
    let mut answer = Vec::new();
    // Whoever ends a connection to which something is still sent resets it.
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

/// Nothing of these requests is missing: the station cannot read who is logged in, as from a network share that hangs.
#[test]
fn a_station_that_is_late_itself_says_so_and_that_an_act_may_be_done_all_the_same() {
    let station = Station::public(1);
    let serving = station.serve();
    let operator = serving.operator();
    let path = station.path("users.toml");
    fs::remove_file(&path).unwrap();
    assert!(Command::new("mkfifo").args(["-m", "600"]).arg(&path).status().unwrap().success());
    let asked =
        [(operator.get("/"), "Try again"), (operator.post("/lanes/1/abort", &[]), "may have been done")];
    let asked = asked.map(|(request, said)| (thread::spawn(move || request.send()), said));
    let held = held_up(&path);
    for (answer, said) in asked {
        let answer = answer.join().unwrap();
        assert!(answer.status == 503 && answer.text().contains(said), "{answer:?}");
    }
    drop(held);
}

/// docs/station-lanes.md: a request has 10 s for its head, and a form 10 s. Nothing else ends either of them before 30 s.
#[test]
fn a_request_that_does_not_arrive_holds_no_place() {
    const OTHERWISE: Duration = Duration::from_secs(29);
    let station = Station::private(1);
    let serving = station.serve();
    let here = serving.here();
    let (look, form) = (here.get("/").text(), here.post("/scan", &[("text", SERIALS[0])]).text());
    let begun = Instant::now();
    thread::scope(|scope| {
        for (text, late) in
            [(&look, ["", ""]), (&form, ["408", "did not arrive in time, and nothing was done"])]
        {
            let (first, rest) = text.split_at(text.len() - 9);
            scope.spawn(move || {
                let ended = answered(serving.port, first, "");
                assert!(
                    begun.elapsed() < OTHERWISE && late.iter().all(|late| ended.contains(late)),
                    "{first}: {ended}"
                );
            });
            let ended = answered(serving.port, first, rest);
            assert!(ended.lines().next().is_some_and(|status| status.contains("200")), "{text}: {ended}");
        }
    });
}
