//! Section 4 of WIRE.md: credit and acknowledgement.

use halfrow_protocol::message::{RefusalCode, Request};

use crate::bench::{Bench, rows_of, wire};
use crate::frames::{ready, ready_if_offered, row};
use crate::{Boards, Build, offered};

fn banks(row_banks_in: u8, row_banks_out: u8) -> Build {
    Build { row_banks_in, row_banks_out, ..Build::default() }
}

fn window(bench: &mut Bench) -> u32 {
    bench.done(&Request::Echo(b"")).header.window
}

pub(crate) fn credit_reaches_past_the_first_row_that_has_not_entered_by_the_input_banks(on: &dyn Boards) {
    let Some(mut bench) = ready_if_offered(on, &banks(4, 2), 8) else { return };
    let mut windows = vec![window(&mut bench)];
    for number in 0..5 {
        bench.send_all(8, [number]);
        windows.push(window(&mut bench));
    }
    // Two output banks: the third row waits, and so do those after it.
    assert_eq!(windows, [4, 5, 6, 6, 6, 6]);
}

pub(crate) fn a_row_at_or_beyond_the_window_is_refused(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 8);
    for number in [4, 5, 1000, u32::MAX] {
        assert_eq!(bench.send(&row(8, number))[0].refusal(), Some((RefusalCode::Credit, 0)));
    }
    assert_eq!(bench.send(&row(8, 1)), []);
    bench.send_all(8, [0]);
    assert_eq!(bench.send(&row(8, 6))[0].refusal(), Some((RefusalCode::Credit, 0)));
    assert_eq!(rows_of(&bench.send(&row(8, 5))), []);
    assert_eq!(bench.status().rows_in, 3);
}

pub(crate) fn an_acknowledgement_in_any_packet_frees_output_banks(on: &dyn Boards) {
    for carrier in [Request::RowAck, Request::Echo(b""), Request::Status { clear: false }] {
        let Some(mut bench) = ready_if_offered(on, &banks(4, 2), 8) else { return };
        bench.send_all(8, 0..4);
        bench.window = 1;
        let heard = bench.say(&carrier);
        let rows: Vec<_> = heard.into_iter().filter(|packet| !packet.header.reply).collect();
        assert_eq!(rows_of(&rows), [1], "row 2 enters and pushes row 1 out");
    }
}

pub(crate) fn even_a_refused_packet_acknowledges(on: &dyn Boards) {
    let Some(mut bench) = ready_if_offered(on, &banks(4, 2), 8) else { return };
    bench.send_all(8, 0..4);
    bench.window = 1;
    let header = bench.header(0x55);
    let heard = bench.receive(&wire(&header, |_| {}));
    assert_eq!(heard.len(), 2);
    assert_eq!(heard[1].row().place.row_sequence, 1);
}

pub(crate) fn a_smaller_window_than_before_means_nothing(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 8);
    bench.send_all(8, 0..4);
    bench.acknowledge(3);
    bench.acknowledge(1);
    bench.window = 0;
    assert_eq!(bench.status().next_row_out, 3);
}

pub(crate) fn rows_that_were_never_sent_back_cannot_be_acknowledged(on: &dyn Boards) {
    let Some(mut bench) = ready_if_offered(on, &banks(2, 2), 8) else { return };
    bench.send_all(8, 0..2);
    bench.acknowledge(u32::MAX);
    assert_eq!(bench.status().next_row_out, 1);
    assert_eq!(rows_of(&bench.send_all(8, [2])), [1]);
}

pub(crate) fn one_acknowledgement_may_free_many_banks(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 8);
    bench.send_all(8, 0..8);
    assert_eq!(window(&mut bench), 8, "rows 4 to 7 wait");
    assert_eq!(rows_of(&bench.acknowledge(3)), [3, 4, 5]);
    assert_eq!(rows_of(&bench.acknowledge(6)), [6, 7]);
}

/// Streams 60 rows in frames of 20. Fails if nothing moves any more.
fn stream(on: &dyn Boards, build: &Build) {
    let mut bench = ready(on, build, 20);
    let mut credit = window(&mut bench);
    let mut sent = 0;
    while bench.window < 60 {
        let mut heard = bench.send_all(20, sent..credit.min(60));
        sent = credit.min(60);
        heard.extend(bench.say(&Request::RowAck));
        assert!(!heard.is_empty(), "{build:?}: stuck at {}", bench.window);
        let back = bench.window + heard.len() as u32;
        assert_eq!(rows_of(&heard), (bench.window..back).collect::<Vec<_>>());
        bench.window = back;
        credit = heard.iter().map(|packet| packet.header.window).fold(credit, u32::max);
    }
}

pub(crate) fn frames_stream_through_any_number_of_banks(on: &dyn Boards) {
    for row_banks_in in [2, 3, 4, 255] {
        for build in offered(on, [2, 3, 4, 255].map(|row_banks_out| banks(row_banks_in, row_banks_out))) {
            stream(on, &build);
        }
    }
}
