//! `halfrow link` on wires whose figures are known.

use halfrow_tests::program::{Ended, halfrow};
use halfrow_tests::served::Served;

use crate::ends;

fn measure(target: &str) -> Ended {
    halfrow(["link", "--json", "--seconds", "0.5", "--board", target])
}

#[test]
fn a_wire_is_measured_to_be_what_it_is() {
    // 1.2 MB/s, and 1 ms each way.
    let ended = measure("mock,speed=1200000,delay=0.001").succeeded();
    let figures = &ended.json()["link"];
    assert_eq!((figures["limit"].as_f64(), figures["errors"]["wrong"].as_u64()), (Some(1.2e6), Some(0)));
    // An empty packet takes 18 or 19 bytes, so the round trip is 2 ms and some 31 µs.
    let median = figures["round_trips"]["median_us"].as_f64().unwrap();
    assert!((2000.0..2050.0).contains(&median), "{median}");
    // A packet of 4,079 bytes and its answer of 18 need 3.44 ms on the wire and 2 ms of delay.
    for (part, way, other) in [("to_board", "out", "in"), ("to_host", "in", "out")] {
        let part = &figures[part];
        let share = part[way]["share"].as_f64().unwrap();
        assert!((0.60..0.65).contains(&share), "{part}");
        assert!(part[other]["share"].as_f64().unwrap() < 0.01, "{part}");
    }
    for way in ["out", "in"] {
        let share = figures["together"][way]["share"].as_f64().unwrap();
        assert!((0.95..=1.0).contains(&share), "{}", figures["together"]);
    }
}

#[test]
fn errors_are_counted_on_either_side() {
    for (toward, counter, other) in
        [("board", "damaged_out", "damaged_in"), ("host", "damaged_in", "damaged_out")]
    {
        let ended = measure(&format!("mock,speed=1200000,fault=flip,rate=1e-5,toward={toward}")).succeeded();
        let errors = &ended.json()["link"]["errors"];
        let (damaged, bytes) = (errors[counter].as_f64().unwrap(), errors["bytes"].as_f64().unwrap());
        // One byte in 100,000, and about half of all bytes go this way.
        assert!((0.3..1.5).contains(&(damaged / (bytes * 0.5e-5))), "{errors}");
        assert_eq!(errors[other], 0);
        assert!(errors["bound"].as_f64() > errors["rate"].as_f64());
    }
}

#[test]
fn a_real_link_is_measured_and_its_board_left_free() {
    for served in [Served::on_a_serial_port("mock"), Served::on_a_tcp_port("127.0.0.1", "mock")] {
        let ended = measure(&served.target()).succeeded();
        let said = ended.json();
        assert_eq!((&said["board"]["kind"], &said["verdict"]), (&"mock".into(), &serde_json::Value::Null));
        assert!(said["link"]["together"]["out"]["bytes_per_second"].as_f64().unwrap() > 0.0);
        crate::passes(&served);
    }
}

/// By the limit that a run has: 16 packets, and 5 % of those that were sent.
#[test]
fn a_link_is_told_to_be_good_enough_for_a_run_or_too_poor() {
    let measured = |target: &str| halfrow(["link", "--seconds", "0.5", "--board", target]);
    for (board, code, verdict) in [
        ("mock,speed=1200000", 0, "good enough for verify: 0.0 % sent again (0 of "),
        ("mock,fault=flip,rate=1e-4,speed=300000", 3, "too poor for verify: "),
    ] {
        let ended = measured(board);
        assert_eq!(ended.code, Some(code), "{}{}", ended.stdout, ended.stderr);
        let last = ended.stdout.lines().last().unwrap();
        assert!(last.contains(verdict) && last.ends_with("the limit is 16 plus 5 %"), "{}", ended.stdout);
    }
    // A run over either link says the same.
    let judged = |target: &str| {
        halfrow([
            "verify", "--json", "-q", "--width", "640", "--height", "360", "--radius", "368", "--board",
            target,
        ])
    };
    judged("mock,speed=1200000").succeeded();
    ends(&judged("mock,fault=flip,rate=1e-4,speed=300000"), 3, "the link is too poor");
}

#[test]
fn a_poor_link_is_measured_to_its_end() {
    let poor = "mock,speed=1200000,fault=flip,rate=1e-4";
    ends(&halfrow(["link", "--json", "--retry-limit", "1", "--board", poor]), 3, "the link is too poor");
    let ended = measure(poor);
    assert_eq!(ended.code, Some(3), "{}", ended.stderr);
    let said = ended.json();
    assert_eq!((&said["exit_code"], &said["link"]["too_poor"]), (&3.into(), &true.into()), "{said}");
    let errors = &said["link"]["errors"];
    assert!(errors["retries"].as_u64() > said["link"]["retry_limit"].as_u64(), "{said}");
    assert!(
        errors["damaged_out"].as_u64() > Some(20) && errors["damaged_in"].as_u64() > Some(20),
        "{errors}"
    );
}

/// None of eight tries in succession gets through.
#[test]
fn a_link_test_that_a_poor_link_breaks_off_has_its_figures() {
    let poor = |rate: &str| format!("mock,speed=1200000,fault=drop,rate={rate}");
    for rate in ["2e-4", "4e-4"] {
        let ended = measure(&poor(rate));
        assert_eq!(ended.code, Some(3), "{}", ended.stderr);
        let said = ended.json();
        assert_eq!((&said["exit_code"], &said["link"]["too_poor"]), (&3.into(), &true.into()), "{said}");
        assert_eq!(said["error"]["code"], "link-test-on-poor-link");
        assert_eq!(said["board"]["kind"], "mock");
        let errors = &said["link"]["errors"];
        assert!(errors["retries"].as_u64() > Some(7), "{said}");
        assert!(
            errors["damaged_in"].as_u64() > Some(0) && errors["damaged_out"].as_u64() > Some(0),
            "{said}"
        );
    }
    let ended = halfrow(["link", "--seconds", "0.5", "--board", &poor("2e-4")]);
    let lines: Vec<_> = ended.stdout.lines().collect();
    let [_, _, damaged, judging] = lines[..] else { panic!("{}", ended.stdout) };
    assert!(damaged.starts_with("damaged ") && damaged.contains(" sent again"), "{damaged}");
    assert!(
        judging.starts_with("judging ")
            && judging.contains("too poor for verify, since this test broke off: "),
        "{judging}"
    );
    assert!(ended.stderr.contains("; check cable, connectors and rate"), "{}", ended.stderr);
    assert!(!ended.stderr.contains("halfrow verify"), "{}", ended.stderr);
}

/// Whether the board or the link loses it is not known then.
#[test]
fn a_link_test_that_one_lost_row_breaks_off_asks_for_a_run() {
    let ended = measure("mock,speed=1200000,fault=lost-row,row=40");
    ends(&ended, 3, "run `halfrow verify` to find out whether the board or the link loses it");
    assert_eq!(ended.json()["error"]["code"], "row-missing");
}

#[test]
fn a_link_that_breaks_is_an_error() {
    let served = Served::on_a_serial_port("mock,fault=disconnect,packet=30");
    ends(&measure(&served.target()), 3, "the link broke while waiting for the answer to");
    let gone = halfrow(["link", "--seconds", "0", "--board", "mock"]);
    assert_eq!(gone.code, Some(2), "{}", gone.stderr);
}
