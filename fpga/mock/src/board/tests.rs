//! What could be seen from outside only after 2^32 packets.

use std::time::Duration;

use halfrow_protocol::message::{Configuration, RowIn, RowPlace, Status};
use halfrow_protocol::{Encoder, Header, Kind};

use super::Board;
use crate::options::Options;

const END: u32 = u32::MAX;

fn board() -> Board {
    Board::new(&Options::default(), None).unwrap()
}

#[test]
fn counters_of_packets_stay_at_their_end() {
    let mut board = board();
    let at_end = Status {
        packets: END,
        crc_errors: END,
        framing_errors: END,
        foreign_packets: END,
        refusals: END,
        ..board.report(false)
    };
    board.status = at_end;
    let header = Header { kind: Kind::Capabilities.code(), session: 9, ..Header::default() };
    let mut bytes = Vec::new();
    Encoder::new().encode(&header, |_| {}, &mut bytes).unwrap();
    board.receive(&bytes, Duration::ZERO);
    let crc = bytes.len() - 2;
    bytes[crc] ^= 0x80;
    board.receive(&bytes, Duration::ZERO);
    board.receive(&[0, 7, 0], Duration::ZERO);
    assert_eq!(board.report(false), at_end);
}

#[test]
fn counters_of_rows_stay_at_their_end() {
    let mut board = board();
    let configuration =
        Configuration { width: 64, height: 1, centre2: 63, blanking: 0, gap_seed: 0, bits: 8 };
    board.configure(&configuration).unwrap();
    board.tables.commit(1, 0).unwrap();
    let counters =
        Status { rows_in: END, rows_out: END, rows_repeated: END, rows_unneeded: END, ..Status::default() };
    board.status = Status { samples_over: END - 63, ..counters };
    let place = RowPlace { width: 64, last: true, ..RowPlace::default() };
    let row = RowIn { place, packed: &[0xff; 96] };
    board.row_in(&row).unwrap();
    board.row_in(&row).unwrap();
    board.play();
    board.flush();
    board.row_in(&row).unwrap();
    let Status { rows_in, rows_out, rows_repeated, rows_unneeded, samples_over, .. } = board.report(false);
    assert_eq!([rows_in, rows_out, rows_repeated, rows_unneeded, samples_over], [END; 5]);
}
