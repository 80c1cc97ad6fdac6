//! Boards that are sound but for one rule, which the least run with the rules finds.

use halfrow::board::RefusalCode;
use halfrow::result::Rule;
use halfrow_mock::Options;
use halfrow_protocol::message::{FrameRecord, Records};
use halfrow_protocol::{Kind, Reply};

use super::rules::{broken, carried_out, refusal, said_by};

/// Records do not fit into one packet then.
fn many_records() -> Options {
    Options { records: 300, ..Options::default() }
}

#[test]
fn a_board_of_many_records_refuses_what_it_must_while_a_burst_is_under_way() {
    let report = said_by(&many_records(), |packet| {
        let busy = refusal(&packet).filter(|refusal| refusal.code == RefusalCode::Busy);
        match busy.filter(|refusal| refusal.kind == Kind::Expect.code()) {
            Some(refusal) => Some(carried_out(&packet, refusal)),
            None => Some(packet),
        }
    });
    assert_eq!(broken(&report).0, Rule::UnderWay);
}

/// The last record that there is room for, which no packet has that begins with the first.
#[test]
fn a_board_of_many_records_tells_the_last_of_them() {
    let report = said_by(&many_records(), |mut packet| {
        let from = match packet.reply() {
            Some(Reply::Records(records)) => records.from as usize,
            _ => return Some(packet),
        };
        let place = 299_usize.checked_sub(from).map(|record| Records::HEAD + record * FrameRecord::BYTES);
        if let Some(byte) = place.and_then(|place| packet.payload.get_mut(place)) {
            *byte ^= 1;
        }
        Some(packet)
    });
    assert_eq!(broken(&report).0, Rule::Records);
}
