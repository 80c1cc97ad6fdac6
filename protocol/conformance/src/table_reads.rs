//! TABLE_READ and TABLE_CRC: what comes back, through which port, and when.

use halfrow_protocol::message::{Bank, Capabilities, RefusalCode, Request, Reset, ResetLevel, Table};

use crate::bench::{Bench, HELLO};
use crate::frames::{lean, ready};
use crate::material::{UNSTRETCHED, crc_of_words, factors, hermite, keys};
use crate::uploads::{TableSet, span, write, write_both_banks};
use crate::{Boards, Build, offered};

/// A board with the golden tables of 1080 rows in the shadow bank.
fn golden(on: &dyn Boards) -> Bench {
    let mut bench = Bench::greeted(on);
    let bytes: Vec<_> = factors(1080, 1106.697).into_iter().flat_map(u32::to_le_bytes).collect();
    bench.done(&write(Table::RowFactors, 0, &bytes[..2160]));
    bench.done(&write(Table::RowFactors, 540, &bytes[2160..]));
    let bytes: Vec<_> = hermite().into_iter().flatten().flat_map(i16::to_le_bytes).collect();
    bench.done(&write(Table::Kernel, 0, &bytes));
    bench
}

pub(crate) fn the_golden_tables_read_back_with_the_golden_crcs_through_every_port(on: &dyn Boards) {
    let mut bench = golden(on);
    for port in 0..bench.capabilities().step_ports {
        assert_eq!(bench.crc(span(Table::RowFactors, Bank::Shadow, port, 0, 1080)), 0x5f5a_7553);
    }
    for port in 0..bench.capabilities().kernel_ports {
        assert_eq!(bench.crc(span(Table::Kernel, Bank::Shadow, port, 0, 65)), 0x16e2_9b0f);
    }
}

pub(crate) fn a_read_answers_with_its_span_and_the_entries(on: &dyn Boards) {
    let mut bench = golden(on);
    let payload = bench.done(&Request::TableRead(span(Table::RowFactors, Bank::Shadow, 0, 539, 1))).payload;
    // Q[539] of the golden table is 16777214.
    assert_eq!(payload, [0, 0, 0, 0x1b, 0x02, 1, 0, 0xfe, 0xff, 0xff, 0x00]);
    let port = bench.capabilities().kernel_ports - 1;
    let payload = bench.done(&Request::TableRead(span(Table::Kernel, Bank::Shadow, port, 32, 1))).payload;
    // Hermite at x = 1: r1 = −1/8, g4 = 1/2, r5 = −1/8, in units of 2^-14.
    assert_eq!(payload, [1, 0, port, 32, 0, 1, 0, 0, 0, 0, 0xf8, 0, 0x20, 0, 0xf8, 0, 0]);
}

/// Checks that every factor of both banks is 2^24 and every node 0, through every port.
fn expect_blank(bench: &mut Bench, rows: u16) {
    let unstretched = vec![UNSTRETCHED.to_le_bytes(); rows.into()].concat();
    let Capabilities { step_ports, kernel_ports, .. } = bench.capabilities();
    for bank in [Bank::Shadow, Bank::Active] {
        for port in 0..step_ports {
            assert_eq!(
                bench.crc(span(Table::RowFactors, bank, port, 0, rows)),
                crc32fast::hash(&unstretched)
            );
        }
        for port in 0..kernel_ports {
            assert_eq!(bench.crc(span(Table::Kernel, bank, port, 0, 65)), crc_of_words([0; 325]));
        }
    }
}

pub(crate) fn before_any_write_nothing_is_stretched_and_all_nodes_are_0(on: &dyn Boards) {
    for build in offered(on, [Build::default(), lean()]) {
        let mut bench = Bench::switched_on(on, &build);
        bench.greet(&HELLO);
        expect_blank(&mut bench, build.max_height);
        write_both_banks(&mut bench, |_| {});
        bench.done(&Request::Reset(Reset { level: ResetLevel::Tables, next_row: 0 }));
        expect_blank(&mut bench, build.max_height);
    }
}

pub(crate) fn the_crc_of_no_entries_is_that_of_no_bytes(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    assert_eq!(bench.crc(span(Table::RowFactors, Bank::Shadow, 0, 2048, 0)), 0);
    assert_eq!(bench.crc(span(Table::Kernel, Bank::Active, 0, 65, 0)), 0);
}

pub(crate) fn ports_and_entries_that_are_not_there_are_refused(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    let Capabilities { step_ports, kernel_ports, .. } = bench.capabilities();
    for wrong in [
        span(Table::RowFactors, Bank::Shadow, step_ports, 3, 1),
        span(Table::Kernel, Bank::Shadow, kernel_ports, 3, 1),
        span(Table::RowFactors, Bank::Active, 0, 2047, 2),
        span(Table::RowFactors, Bank::Active, 0, 2049, 0),
        span(Table::Kernel, Bank::Shadow, 0, 64, 2),
        span(Table::Kernel, Bank::Shadow, 0, 0, 66),
        span(Table::Kernel, Bank::Shadow, 0, 0xffff, 0xffff),
    ] {
        for request in [Request::TableRead(wrong), Request::TableCrc(wrong)] {
            assert_eq!(bench.refused(&request), (RefusalCode::Range, wrong.first), "{request:?}");
        }
    }
}

pub(crate) fn a_read_that_fits_no_packet_is_refused_and_its_crc_is_not(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    // A packet has room for 4080 bytes, of which the span takes 7.
    let payload = bench.done(&Request::TableRead(span(Table::RowFactors, Bank::Shadow, 0, 5, 1018))).payload;
    assert_eq!(payload.len(), 7 + 4 * 1018);
    let longer = span(Table::RowFactors, Bank::Shadow, 0, 5, 1019);
    assert_eq!(bench.refused(&Request::TableRead(longer)), (RefusalCode::Range, 5));
    bench.crc(longer);
    bench.crc(span(Table::RowFactors, Bank::Shadow, 0, 0, 2048));
}

pub(crate) fn both_banks_are_read_and_a_commit_that_takes_effect_swaps_them(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 1);
    let kernel = |bench: &mut Bench, bank| bench.crc(span(Table::Kernel, bank, 0, 0, 65));
    let none = kernel(&mut bench, Bank::Active);
    assert_eq!(none, crc_of_words([0; 325]));
    assert_eq!(kernel(&mut bench, Bank::Shadow), 0x16e2_9b0f);
    bench.send_all(1, [0]);
    assert_eq!(kernel(&mut bench, Bank::Active), 0x16e2_9b0f);
    assert_eq!(kernel(&mut bench, Bank::Shadow), none);
    TableSet::new(&[1], &keys()).upload(&mut bench);
    assert_eq!(kernel(&mut bench, Bank::Active), 0x16e2_9b0f);
    assert_eq!(kernel(&mut bench, Bank::Shadow), 0x54f5_e990);
}

pub(crate) fn nothing_is_read_while_a_row_is_inside(on: &dyn Boards) {
    let mut bench = ready(on, &Build::default(), 2);
    let requests = [
        Request::TableRead(span(Table::RowFactors, Bank::Active, 0, 0, 1)),
        Request::TableCrc(span(Table::Kernel, Bank::Shadow, 0, 0, 1)),
    ];
    bench.send_all(2, [0]);
    for request in &requests {
        assert_eq!(bench.refused(request), (RefusalCode::Busy, 0));
    }
    bench.send_all(2, [1]);
    for request in &requests {
        bench.done(request);
    }
}
