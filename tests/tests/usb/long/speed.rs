//! Prints the speed of the link over the emulated chip. The emulated processor sets the scale, so no speed is too low.

use std::time::{Duration, Instant};

use halfrow::link::{Link, open};
use halfrow_ft2232h::{Chip, ChipOptions, Endless, Plugged};
use halfrow_tests::program::halfrow;
use halfrow_tests::usb::plug;

/// Bytes a second to the board and from it, over two seconds.
fn raw(link: &mut dyn Link, outgoing: &[u8]) -> (f64, f64) {
    let (mut sent, mut came, mut incoming) = (0, 0, Vec::new());
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(2) {
        sent += link.exchange(outgoing, &mut incoming, Duration::from_millis(10)).unwrap();
        came += incoming.len();
        incoming.clear();
    }
    let seconds = begun.elapsed().as_secs_f64();
    (sent as f64 / seconds, came as f64 / seconds)
}

#[test]
#[ignore = "long"]
fn of_the_link_and_of_a_run() {
    let endless = Plugged::new(Chip::new(ChipOptions::default(), Box::new(Endless)), 0).unwrap();
    let mut link = open(&"usb".parse().unwrap()).unwrap().link;
    let (_, in_alone) = raw(link.as_mut(), &[]);
    let (out_both, in_both) = raw(link.as_mut(), &[0x55; 16_384]);
    drop((link, endless));
    println!(
        "from an endless board {:.1} MB/s; both ways {:.1} and {:.1} MB/s",
        in_alone / 1e6,
        out_both / 1e6,
        in_both / 1e6
    );
    assert!(in_alone > 0.0 && out_both > 0.0 && in_both > 0.0, "nothing came through");
    let _board = plug("");
    let ended = halfrow(["verify", "--json", "--board", "usb", "--height", "64", "--frame", "builtin:noise"])
        .succeeded();
    let link = &ended.json()["link"];
    let [seconds, out, came, round_trip] =
        ["seconds", "bytes_out", "bytes_in", "round_trip_us"].map(|name| link[name].as_f64().unwrap());
    assert!(seconds > 0.0 && out > 0.0 && came > 0.0 && round_trip > 0.0, "{link}");
    println!(
        "a run: {:.2} MB/s out, {:.2} MB/s in, {seconds:.2} s, round trip {round_trip} µs",
        out / seconds / 1e6,
        came / seconds / 1e6
    );
}
