//! STATUS: every counter, and what clearing does to it.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Configuration, Request, RowPlace, Status};

use crate::bench::{Bench, HELLO};
use crate::frames::{Row, configuration, ready, row};
use crate::{Boards, Build};

pub(crate) fn counters_are_sent_in_the_order_of_the_page(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 1, 3]);
    bench.acknowledge(1);
    let payload = bench.done(&Request::Status { clear: false }).payload;
    let words: Vec<_> = payload.chunks(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    // HELLO cleared the counters; after it came CONFIGURE, two TABLE_WRITE, COMMIT, three ROW_IN, ROW_ACK, STATUS.
    assert_eq!(words, [9, 0, 0, 0, 0, 3, 1, 0, 0, 0, 2, 1, 1, 1, 44, 44]);
}

pub(crate) fn packets_counts_whole_packets_and_the_status_itself(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.status().packets, 1);
    bench.say(&Request::RowAck);
    bench.done(&Request::Echo(b""));
    let header = bench.header(0x55);
    bench.answer(&header, &[]);
    assert_eq!(bench.status().packets, 5);
}

pub(crate) fn repeated_and_unneeded_rows_are_counted_apart(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 1, 3, 3, 0, 0, 0]);
    bench.acknowledge(1);
    bench.send_all(4, [0]);
    let status = bench.status();
    assert_eq!((status.rows_in, status.rows_repeated, status.rows_unneeded), (3, 3, 2));
}

pub(crate) fn next_row_in_stands_at_the_first_gap(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 2, 3]);
    assert_eq!(bench.status().next_row_in, 1);
    bench.send_all(4, [1]);
    assert_eq!(bench.status().next_row_in, 4);
}

pub(crate) fn next_row_out_follows_the_hosts_window(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..4);
    assert_eq!(bench.status().next_row_out, 0);
    bench.acknowledge(3);
    assert_eq!(bench.status().next_row_out, 3);
}

pub(crate) fn the_core_is_busy_from_a_frames_first_row_to_its_last(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    assert_eq!(bench.status().core_busy, 0);
    bench.send_all(2, [0]);
    assert_eq!(bench.status().core_busy, 1);
    bench.send_all(2, [1]);
    assert_eq!(bench.status().core_busy, 0);
}

pub(crate) fn the_generation_is_the_active_one_not_the_pending_one(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    assert_eq!(bench.status().generation, 0);
    bench.send_all(2, [0]);
    assert_eq!(bench.status().generation, 1);
}

pub(crate) fn samples_beyond_the_depth_are_counted_in_accepted_rows_alone(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    bench.done(&Request::Configure(Configuration { bits: 10, ..configuration(1) }));
    let mut samples = vec![1023; 64];
    samples[5] = 1024;
    samples[9] = 4095;
    let place = row(1, 0).place;
    bench.send(&Row { place: RowPlace { row: 1, ..place }, samples: samples.clone() });
    assert_eq!(bench.status().samples_over, 0, "the row was refused");
    bench.send(&Row { place, samples: samples.clone() });
    bench.send(&Row { place, samples });
    assert_eq!(bench.status().samples_over, 2, "the row was taken once");
}

pub(crate) fn latencies_are_the_smallest_and_the_largest_of_any_row_since_the_clear(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    let latencies = |status: Status| (status.least_latency, status.most_latency);
    let mut found = vec![latencies(bench.status())];
    for (row_sequence, width) in [(0, 64), (1, 128), (2, 64), (3, 96)] {
        bench.window = row_sequence;
        bench.done(&Request::Configure(Configuration { width, ..configuration(1) }));
        let place = RowPlace { width, ..row(1, row_sequence).place };
        bench.send(&Row { place, samples: vec![0; width.into()] });
        found.push(latencies(bench.status_and(row_sequence == 2)));
    }
    assert_eq!(found, [(0, 0), (44, 44), (44, 76), (44, 76), (60, 60)]);
}

pub(crate) fn clearing_answers_with_the_counters_before_it_and_leaves_what_is_no_counter(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, [0, 1, 3, 3, 0]);
    bench.acknowledge(1);
    let open = bench.session;
    bench.session = bench.foreign();
    bench.ask(&Request::Capabilities);
    bench.session = open;
    bench.receive(&[0, 1, 2, 3, 0]);
    let before = bench.status();
    assert_eq!(bench.status_and(true), Status { packets: before.packets + 1, ..before });
    let kept = Status { next_row_in: 2, next_row_out: 1, core_busy: 1, generation: 1, ..Status::default() };
    assert_eq!(bench.status(), Status { packets: 1, ..kept });
}

pub(crate) fn any_clear_but_0_clears(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let header = bench.header(Kind::Status.code());
    assert_eq!(bench.answer(&header, &[0x80]).refusal(), None);
    assert_eq!(bench.status().packets, 1, "this STATUS alone");
}

pub(crate) fn a_status_that_does_not_clear_changes_nothing_but_packets(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 4);
    bench.send_all(4, 0..3);
    let first = bench.status();
    assert_eq!(bench.status(), Status { packets: first.packets + 1, ..first });
}

pub(crate) fn counters_begin_at_0_in_a_session(on: &dyn Boards) {
    let mut bench = Bench::switched_on(on, &Build::default());
    bench.receive(&[0, 1, 2, 3, 0]);
    bench.ask(&Request::Capabilities);
    bench.greet(&HELLO);
    assert_eq!(bench.status(), Status { packets: 1, ..Status::default() });
}
