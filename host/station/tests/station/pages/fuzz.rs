//! Requests that nobody should send. None may end the program, or be answered with an internal error.

use std::time::{Duration, Instant};

use halfrow_station::web::routes;
use rand::TryRng as _;
use rand::rngs::SysRng;

use crate::history::generated::Draw;
use crate::pages::http::{Request, exchange};
use crate::pages::station::{SERIALS, Station};

/// How many seconds it runs, unless `HALFROW_FUZZ_SECONDS` says otherwise.
const SHORT: u64 = 5;

/// The seed of a run as short as [`SHORT`].
const SEED: u64 = 0x6861_6c66_726f_7721;

/// The seed that `HALFROW_FUZZ_SEED` gives. Without it, a run for `HALFROW_FUZZ_SECONDS` draws one, and any other takes [`SEED`].
fn seed() -> u64 {
    match std::env::var("HALFROW_FUZZ_SEED") {
        Ok(text) => text.parse().unwrap(),
        Err(_) if std::env::var_os("HALFROW_FUZZ_SECONDS").is_some() => SysRng.try_next_u64().unwrap(),
        Err(_) => SEED,
    }
}

/// Pseudo-random numbers, the same ones for the same seed.
struct Drawn(Draw);

impl Drawn {
    fn below(&mut self, most: usize) -> usize {
        self.0.below(most as u64) as usize
    }

    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len())]
    }
}

const ODD: [&str; 16] = [
    "",
    "1",
    "-1",
    "99999999999999999999",
    "%00",
    "%ff%fe",
    "..",
    "%2e%2e%2f",
    "HR:LANE:1",
    "HR:OUT",
    "\u{fffd}",
    "<b>",
    "'--",
    "2026-11-22",
    "PASS",
    "x",
];
const FIELDS: [&str; 14] = [
    "text", "lane", "counter", "typed", "badge", "password", "language", "serial", "verdict", "from",
    "until", "after", "plan", "reason",
];
const METHODS: [&str; 7] = ["GET", "POST", "HEAD", "PUT", "DELETE", "OPTIONS", "BREW"];

fn fields(drawn: &mut Drawn) -> String {
    let pairs: Vec<_> = (0..drawn.below(5))
        .map(|_| {
            format!("{}={}", drawn.of(&FIELDS), if drawn.below(4) == 0 { SERIALS[0] } else { drawn.of(&ODD) })
        })
        .collect();
    pairs.join("&")
}

fn path(drawn: &mut Drawn, paths: &[&str]) -> String {
    let known =
        drawn.of(paths).split('/').map(|part| if part.starts_with('{') { drawn.of(&ODD) } else { part });
    let path: Vec<_> = known.collect::<Vec<_>>();
    let path = path.join("/").replace(['\u{fffd}', '<', '>', '\''], "x");
    if drawn.below(2) == 0 {
        path
    } else {
        format!("{path}?{}", fields(drawn).replace(['\u{fffd}', '<', '>', '\''], "x"))
    }
}

#[test]
fn no_request_ends_the_program_or_is_answered_with_its_own_fault() {
    let station = Station::private(2);
    let mut serving = station.serve();
    let here = serving.here();
    let seed = seed();
    println!("HALFROW_FUZZ_SEED={seed}");
    let mut drawn = Drawn(Draw(seed));
    let paths: Vec<_> = routes().iter().map(|route| route.path).collect();
    let seconds = std::env::var("HALFROW_FUZZ_SECONDS").map_or(SHORT, |text| text.parse().unwrap());
    let (start, mut sent) = (Instant::now(), 0_u32);
    while start.elapsed() < Duration::from_secs(seconds) {
        let path = path(&mut drawn, &paths);
        // Half of them are acts with all that it takes to reach the routes.
        let mut request = if drawn.below(2) == 0 { here.post(&path, &[]) } else { here.get(&path) };
        if drawn.below(8) == 0 {
            request.method = drawn.of(&METHODS).to_owned();
        }
        request.body = format!("{}&{}", fields(&mut drawn), request.body);
        if drawn.below(16) == 0 {
            request = request.with(
                drawn.of(&["host", "origin", "cookie", "accept", "accept-language"]),
                drawn.of(&["", "x", ";=;", "a=b=c", "*"]),
            );
        }
        let answer = Request::send(&request);
        assert!(answer.status < 500, "{request:?}: {answer:?}");
        sent += 1;
    }
    for garbage in [&b"\0\0\0\r\n\r\n"[..], b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", &[b'A'; 100_000]] {
        let status = exchange(serving.port, garbage).ok().map(|answer| answer.status);
        assert!(status.is_none_or(|status| (400..500).contains(&status) || status == 505), "{status:?}");
    }
    println!("{sent} requests");
    assert!(sent > 20 && serving.is_alive());
    assert_eq!(here.get("/").send().status, 200);
}
