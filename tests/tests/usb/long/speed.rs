//! The speed of the link over the emulated chip, compared with the chip's own limit. The emulated processor sets the scale.

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
    let _board = plug("");
    let ended = halfrow(["verify", "--json", "--board", "usb", "--height", "64", "--frame", "builtin:noise"]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let link = &ended.json()["link"];
    let number = |name: &str| link[name].as_f64().unwrap_or_default();
    let seconds = number("seconds");
    println!(
        "a run: {:.2} MB/s out, {:.2} MB/s in, {:.2} s, round trip {} µs",
        number("bytes_out") / seconds / 1e6,
        number("bytes_in") / seconds / 1e6,
        seconds,
        number("round_trip_us")
    );
}
