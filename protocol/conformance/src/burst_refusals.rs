//! Section 3 of WIRE.md, from 30 BURST on: what a board refuses, and in which order.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{
    Bank, Burst, BurstMode, Configuration, Entries, Expect, RefusalCode, Request, RowPlace, Span, Status,
    Table,
};

use crate::at_speed::{ENDLESS, HEIGHT, ONE, bursts_of, golden_tables, ready, ready_with};
use crate::bench::{Bench, wire};
use crate::frames::{Row, configuration, lean, row};
use crate::uploads::{TableSet, span, write};
use crate::{Boards, Build};

const BUSY: (RefusalCode, u16) = (RefusalCode::Busy, 0);

pub(crate) fn a_board_that_makes_none_refuses_the_kinds(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let (bursts, trap) = bursts_of(&mut bench).map_or((false, false), |bursts| (true, bursts.trap));
    for (kind, is_known) in
        [(Kind::Burst, bursts), (Kind::Records, bursts), (Kind::Expect, trap), (Kind::Trap, trap)]
    {
        for payload in [&[][..], &[0; 64]] {
            let header = bench.header(kind.code());
            let refusal = bench.answer(&header, payload).refusal();
            assert_eq!(refusal == Some((RefusalCode::Kind, 0)), !is_known, "{kind:?}: {refusal:?}");
        }
    }
}

pub(crate) fn payloads_that_are_too_short_or_without_meaning_are_refused(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    let mut wrong = vec![(Kind::Burst, vec![1; 16]), (Kind::Records, vec![0; 3])];
    wrong.extend([4, 5, 255].map(|mode| (Kind::Burst, [vec![1; 16], vec![mode]].concat())));
    if bursts.trap {
        wrong.extend([(Kind::Expect, vec![0; 3]), (Kind::Expect, vec![0, 0, 2, 0, 1, 2, 3, 4, 5, 6, 7])]);
    }
    for (kind, payload) in wrong {
        let header = bench.header(kind.code());
        let refusal = bench.answer(&header, &payload).refusal();
        assert_eq!(refusal, Some((RefusalCode::Payload, 0)), "{kind:?} {payload:?}");
    }
}

pub(crate) fn without_configuration_or_committed_tables_a_board_is_not_ready(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    if bursts_of(&mut bench).is_none() {
        return;
    }
    let wrong = Burst { burst: 0, frame_blanking: 0, mode: BurstMode::Alternating, ..ONE };
    for configure in [false, true] {
        if configure {
            bench.done(&Request::Configure(configuration(HEIGHT)));
        }
        for burst in [ONE, wrong] {
            assert_eq!(bench.refused(&Request::Burst(burst)), (RefusalCode::NotReady, 0));
        }
    }
    golden_tables().upload(&mut bench);
    bench.done(&golden_tables().commit(1, 0));
    for burst in [ONE, wrong] {
        assert_eq!(bench.refused(&Request::Burst(burst)), (RefusalCode::NotReady, 0), "a commit is pending");
    }
}

pub(crate) fn fields_out_of_range_are_named_the_first_of_several(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    let close = bursts.least_frame_blanking.checked_sub(1);
    let no_name = Burst { burst: 0, frame_blanking: close.unwrap_or(0), ..ONE };
    // Alone, the row that waits would make the board busy.
    bench.send_all(HEIGHT, [1]);
    assert_eq!(bench.refused(&Request::Burst(no_name)), (RefusalCode::Range, 0));
    if let Some(frame_blanking) = close {
        let close = Burst { frame_blanking, ..ONE };
        assert_eq!(bench.refused(&Request::Burst(close)), (RefusalCode::Range, 4));
    }
    if !bursts.trap {
        let trapped = Burst { mode: BurstMode::Trapped, ..ONE };
        assert_eq!(bench.refused(&Request::Burst(trapped)), (RefusalCode::Range, 5));
    }
    let Some((mut bench, bursts)) = ready_with(on, &lean(), configuration(HEIGHT), &golden_tables()) else {
        return;
    };
    let alternating = Burst { mode: BurstMode::Alternating, ..ONE };
    assert_eq!(bench.refused(&Request::Burst(alternating)), (RefusalCode::Range, 5), "there is one bank");
    if let Some(frame_blanking) = bursts.least_frame_blanking.checked_sub(1) {
        let both = Burst { frame_blanking, ..alternating };
        assert_eq!(bench.refused(&Request::Burst(both)), (RefusalCode::Range, 4));
    }
}

pub(crate) fn no_burst_starts_while_the_board_holds_rows_or_a_commit_or_makes_another(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    let refused = |bench: &mut Bench| assert_eq!(bench.refused(&Request::Burst(ONE)), BUSY);
    bench.send_all(HEIGHT, [1]);
    refused(&mut bench);
    bench.send_all(HEIGHT, [0]);
    refused(&mut bench);
    bench.send_all(HEIGHT, [2, 3]);
    refused(&mut bench);
    bench.acknowledge(3);
    refused(&mut bench);
    bench.acknowledge(4);
    TableSet::unstretched(HEIGHT).upload(&mut bench);
    bench.done(&TableSet::unstretched(HEIGHT).commit(2, 1));
    refused(&mut bench);
    let Some((mut bench, _)) = ready(on) else { return };
    bench.done(&Request::Burst(ENDLESS));
    assert_eq!(bench.refused(&Request::Burst(Burst { burst: 2, ..ONE })), BUSY);
    assert_eq!(bench.records(0).burst, ENDLESS.burst, "the other one is under way");
}

pub(crate) fn while_a_burst_is_under_way_a_row_counts_as_inside(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    bench.done(&Request::Burst(ENDLESS));
    let other = TableSet::unstretched(HEIGHT).commit(2, 1);
    let configure = Request::Configure(configuration(HEIGHT));
    let wide = Request::Configure(Configuration { width: 65, ..configuration(HEIGHT) });
    let factors = span(Table::RowFactors, Bank::Active, 0, 0, 1);
    for request in [
        configure,
        wide,
        other,
        Request::TableRead(factors),
        Request::TableRead(Span { port: 99, ..factors }),
        Request::TableCrc(span(Table::Kernel, Bank::Shadow, 1, 0, 65)),
    ] {
        assert_eq!(bench.refused(&request), BUSY, "{request:?}");
    }
    if bursts.trap {
        for first in [0, u16::MAX] {
            assert_eq!(bench.refused(&Request::Expect(Expect { first, bytes: &[[0; 4]] })), BUSY);
        }
    }
    bench.done(&golden_tables().commit(1, 0));
    assert_eq!(bench.status().core_busy, 1);
}

pub(crate) fn tables_are_written_during_a_burst_that_does_not_use_them(on: &dyn Boards) {
    let factor = 7_u32.to_le_bytes();
    let one = write(Table::RowFactors, 0, &factor);
    for (build, mode, is_written) in [
        (Build::default(), BurstMode::Repeating, true),
        (Build::default(), BurstMode::Alternating, false),
        (lean(), BurstMode::Repeating, false),
    ] {
        let Some((mut bench, _)) = ready_with(on, &build, configuration(HEIGHT), &golden_tables()) else {
            continue;
        };
        bench.done(&Request::Burst(Burst { mode, ..ENDLESS }));
        let refusal = bench.ask(&one).refusal();
        assert_eq!(refusal, (!is_written).then_some(BUSY), "{mode:?}, {} banks", build.table_banks);
        let active = span(Table::RowFactors, Bank::Active, 0, 0, 0);
        let write = Request::TableWrite(Entries { span: active, bytes: &[] });
        assert_eq!(bench.refused(&write), (RefusalCode::Range, 0), "the bank comes first");
    }
}

pub(crate) fn rows_are_refused_during_a_burst_whatever_they_are(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    bench.done(&Request::Burst(ENDLESS));
    let far = RowPlace { row_sequence: u32::MAX, ..row(HEIGHT, 0).place };
    let wide = RowPlace { width: 66, ..row(HEIGHT, 0).place };
    for place in [row(HEIGHT, 0).place, far, wide] {
        let samples = vec![0; place.width.into()];
        let heard = bench.send(&Row { place, samples });
        assert_eq!(heard.len(), 1);
        assert_eq!(heard[0].refusal(), Some(BUSY), "{place:?}");
    }
    let header = bench.header(Kind::RowIn.code());
    let short = bench.receive(&wire(&header, |to| to.extend([0; 11])));
    assert_eq!(short[0].refusal(), Some((RefusalCode::Payload, 0)));
}

pub(crate) fn rows_of_a_burst_count_in_no_counter(on: &dyn Boards) {
    let Some((mut bench, _)) = ready(on) else { return };
    bench.status_and(true);
    bench.signed(&ONE);
    let Status { rows_in, rows_out, samples_over, next_row_in, next_row_out, .. } = bench.status();
    assert_eq!([rows_in, rows_out, samples_over, next_row_in, next_row_out], [0; 5]);
    let Status { least_latency, most_latency, refusals, core_busy, .. } = bench.status();
    assert_eq!([least_latency, most_latency, refusals, core_busy], [0; 4]);
}

pub(crate) fn expected_signatures_end_before_max_height(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    if !bursts.trap {
        return;
    }
    let expect = |first, bytes| Request::Expect(Expect { first, bytes });
    let two = [[1; 4]; 2];
    assert_eq!(bench.refused(&expect(2047, &two)), (RefusalCode::Range, 2047));
    assert_eq!(bench.refused(&expect(u16::MAX, &[])), (RefusalCode::Range, u16::MAX));
    bench.done(&expect(2046, &two));
    bench.done(&expect(2048, &[]));
}
