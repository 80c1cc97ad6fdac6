//! Section 1 of WIRE.md: bytes after the fields that a receiver knows are skipped.

use halfrow_protocol::message::{
    Bank, Burst, BurstMode, BurstState, Commit, Expect, Reply, Request, Reset, ResetLevel, RowIn, Shape,
    Table,
};

use crate::Boards;
use crate::at_speed::{FRAME, ONE, ROWS, ready};
use crate::bench::{Bench, ReceivedPacket, wire};
use crate::frames::{configuration, row, samples_of};
use crate::golden_rows::HERMITE;
use crate::material::{GOLDEN_FACTOR, UNSTRETCHED, hermite};
use crate::uploads::{TableSet, span, write};

/// What a later version may append. These bytes are also legal as row factors and as signatures.
const APPENDED: [u8; 8] = [1, 0, 0, 0, 1, 0, 0, 0];

/// Sends a request with bytes after its fields; it must be carried out.
fn longer(bench: &mut Bench, request: &Request<'_>) -> ReceivedPacket {
    let header = bench.header(request.kind().code());
    let mut payload = Vec::new();
    request.write(&mut payload);
    payload.extend(APPENDED);
    let answer = bench.answer(&header, &payload);
    assert_eq!(answer.refusal(), None, "{request:?}");
    answer
}

pub(crate) fn requests_may_carry_fields_of_a_later_version(on: &dyn Boards) {
    let mut bench = Bench::greeted(on);
    longer(&mut bench, &Request::Capabilities);
    longer(&mut bench, &Request::Configure(configuration(1)));
    let tables = TableSet::new(&[GOLDEN_FACTOR], &hermite());
    tables.upload(&mut bench);
    longer(&mut bench, &write(Table::RowFactors, 0, &GOLDEN_FACTOR.to_le_bytes()));
    let factors = |count| span(Table::RowFactors, Bank::Shadow, 0, 0, count);
    let entries = [GOLDEN_FACTOR, UNSTRETCHED].map(u32::to_le_bytes).concat();
    assert_eq!(longer(&mut bench, &Request::TableRead(factors(2))).payload[7..], entries);
    let crc = Reply::TableCrc(crc32fast::hash(&entries));
    assert_eq!(longer(&mut bench, &Request::TableCrc(factors(2))).reply(), crc);
    let Request::Commit(commit) = tables.commit(1, 0) else { unreachable!() };
    // After a shape: without one, the appended bytes would be read as the shape.
    longer(&mut bench, &Request::Commit(Commit { shape: Some(Shape { v: 0, k: 0 }), ..commit }));
    assert_eq!(samples_of(&long_row(&mut bench).row()), HERMITE);
    longer(&mut bench, &Request::Reset(Reset { level: ResetLevel::Rows, next_row: 5 }));
    let Reply::Status(status) = longer(&mut bench, &Request::Status { clear: false }).reply() else {
        panic!()
    };
    assert_eq!((status.next_row_in, status.generation), (5, 1));
}

/// Sends the golden row with bytes after its samples, and returns what comes back.
fn long_row(bench: &mut Bench) -> ReceivedPacket {
    let row = row(1, 0);
    let mut payload = Vec::new();
    RowIn::write_samples(&row.place, &row.samples, &mut payload);
    payload.extend(APPENDED);
    let header = bench.header(0x20);
    bench.receive(&wire(&header, |to| to.extend(payload))).remove(0)
}

pub(crate) fn requests_of_bursts_may_carry_fields_of_a_later_version(on: &dyn Boards) {
    let Some((mut bench, bursts)) = ready(on) else { return };
    let mode = if bursts.trap { BurstMode::Trapped } else { BurstMode::Fresh };
    if bursts.trap {
        let bytes = ROWS.map(u32::to_le_bytes);
        longer(&mut bench, &Request::Expect(Expect { first: 0, bytes: &bytes }));
    }
    longer(&mut bench, &Request::Burst(Burst { mode, ..ONE }));
    bench.records_when(0, |told| told.state == BurstState::Ended);
    let answer = longer(&mut bench, &Request::Records { from: 0 });
    let Reply::Records(records) = answer.reply() else { panic!("{answer:?}") };
    assert_eq!(records.records().map(|record| record.signature).collect::<Vec<_>>(), [FRAME]);
    if bursts.trap {
        assert_eq!(longer(&mut bench, &Request::Trap).reply(), Reply::Trap(None), "all rows were expected");
    }
}
