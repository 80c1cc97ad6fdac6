//! Boards that are sound except for one rule, which the smallest run with the rules finds.

use halfrow::board::RefusalCode;
use halfrow::result::{CheckName, Counter, Finding, Report, Rule};
use halfrow_mock::Options;
use halfrow_protocol::message::{FrameRecord, NODES, Records, Refusal, Status};
use halfrow_protocol::samples::{pack, unpack};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{failed_check, judge_by_plan};

use super::by_the_rules::{
    altering, altering_each, answering, broken, carried_out, counting, hearing, miscounted, plan, refusal,
    refusing, said_by,
};

/// A span's table, first entry and entries (WIRE.md, 10).
fn span(payload: &[u8]) -> (u8, u16, u16) {
    let number = |at: usize| u16::from_le_bytes([payload[at], payload[at + 1]]);
    (payload[0], number(3), number(5))
}

/// So many records that they do not fit into one packet.
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

/// The last record of the memory, which is in no packet that begins with the first.
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

/// The depths that a configuration may have, in bits.
const DEPTHS: [u8; 3] = [8, 10, 12];
/// The bytes of CONFIGURE with the gap seed and the depth (WIRE.md, 18).
const GAP_SEED: usize = 8;
const DEPTH: usize = 12;

/// The report on a board that stores what `stored` makes of a configuration that it refuses.
fn storing(stored: impl Fn(&mut Vec<u8>) + Send + 'static) -> Report {
    let (mut swallowed, mut stored_so_far) = (None, 0);
    altering(move |toward, packet| {
        let is_refused = packet.is(Kind::Configure) && packet.payload.starts_with(&[65, 0]);
        if toward == Toward::Board && is_refused {
            let mut other = packet.clone();
            stored(&mut other.payload);
            swallowed = Some(packet.header.sequence);
            stored_so_far += 1;
            return vec![other, packet];
        }
        if let Some(Reply::Status(status)) = packet.reply().filter(|_| toward == Toward::Host) {
            // The host sent one packet where the board received two.
            let packets = status.packets - stored_so_far;
            return vec![packet.saying(&Reply::Status(Status { packets, ..status }))];
        }
        let is_swallowed = toward == Toward::Host && swallowed == Some(packet.header.sequence);
        if is_swallowed && packet.is(Kind::Configure) { Vec::new() } else { vec![packet] }
    })
}

#[test]
fn a_refused_configuration_must_not_be_stored() {
    let as_small = |payload: &mut Vec<u8>| {
        payload[..6].copy_from_slice(&[64, 0, 4, 0, 63, 0]);
        payload[DEPTH] = 12;
    };
    let gaps = storing(as_small);
    assert_eq!(broken(&gaps).0, Rule::Configuration);
    let depth = storing(move |payload| {
        as_small(payload);
        payload[DEPTH] = 8;
    });
    assert_eq!(broken(&depth).0, Rule::Configuration);
    let size = storing(|payload| payload[..2].copy_from_slice(&[66, 0]));
    assert_eq!(broken(&size).0, Rule::Configuration);
}

#[test]
fn every_bit_of_a_gap_seed_counts() {
    for kept in [1_u32, 0xff, 0xffff, 0x7fff_ffff] {
        let report = hearing(Kind::Configure, move |payload| {
            if let Some(seed) = payload.get_mut(GAP_SEED..GAP_SEED + 4) {
                seed.iter_mut().zip(kept.to_le_bytes()).for_each(|(byte, kept)| *byte &= kept);
            }
        });
        assert_eq!(broken(&report).0, Rule::Configuration, "{kept:x}");
    }
}

#[test]
fn configurations_wait_for_rows_that_are_kept_and_for_those_inside_before_they_are_looked_at() {
    let is_busy = |packet: &Passing| refusal(packet).filter(|refusal| refusal.code == RefusalCode::Busy);
    let is_right = |payload: &[u8]| payload.len() == 13 && DEPTHS.contains(&payload[DEPTH]);
    let taken = answering(Kind::Configure, is_right, move |packet| {
        if let Some(refusal) = is_busy(packet) {
            *packet = carried_out(packet, refusal);
        }
    });
    assert_eq!(broken(&taken).0, Rule::Inside);
    let looked_at = answering(
        Kind::Configure,
        |_| true,
        move |packet| {
            if let Some(busy) = is_busy(packet) {
                let range = Refusal { code: RefusalCode::Range, detail: 5, ..busy };
                *packet = packet.saying(&Reply::Refusal(range));
            }
        },
    );
    assert_eq!(broken(&looked_at).0, Rule::Inside);
}

#[test]
fn samples_beyond_their_depth_go_in_as_they_are() {
    for clips in [false, true] {
        let mut depth = 12;
        let report = altering_each(move |toward, packet| {
            // Those that must be refused are wider.
            if toward == Toward::Board && packet.is(Kind::Configure) && packet.payload.starts_with(&[64, 0]) {
                depth = *packet.payload.get(DEPTH).unwrap_or(&depth);
            }
            let most = (1_u16 << depth.min(12)) - 1;
            if toward == Toward::Board && packet.is(Kind::RowIn) && packet.payload.len() == 12 + 96 {
                let mut samples = [0; 64];
                unpack(&packet.payload[12..], &mut samples);
                let samples = samples.map(|sample| if clips { sample.min(most) } else { sample & most });
                packet.payload.truncate(12);
                pack(&samples, &mut packet.payload);
            }
        });
        assert_eq!(broken(&report).0, Rule::Samples);
    }
}

#[test]
fn samples_beyond_their_depth_are_counted() {
    let report = said_by(&Options::default(), |packet| match packet.reply() {
        Some(Reply::Status(status)) => {
            Some(packet.saying(&Reply::Status(Status { samples_over: 0, ..status })))
        }
        _ => Some(packet),
    });
    assert_eq!(failed_check(&report), Some(CheckName::Rules), "{}", report.headline());
    let Finding::CounterWrong { counter, counted: 0, right: 1.., rule } = report.finding else {
        panic!("{}", report.headline());
    };
    assert_eq!((counter, rule), (Counter::SamplesOver, Some(Rule::Samples)));
}

/// What a later version may append, and fields that boards ignore.
#[test]
fn what_is_to_be_skipped_is_no_reason_to_refuse() {
    for (kind, fields) in [
        (Kind::Status, 1),
        (Kind::TableWrite, 7),
        (Kind::TableRead, 7),
        (Kind::TableCrc, 7),
        (Kind::Configure, 13),
        (Kind::Reset, 5),
        (Kind::RowIn, 12 + 96),
        (Kind::Burst, 17),
        (Kind::Records, 4),
        (Kind::Expect, 8),
    ] {
        let report = hearing(kind, move |payload| {
            if payload.len() == fields + 1 {
                payload.truncate(fields - 1);
            }
        });
        let rule = broken(&report).0;
        assert!([Rule::Skipped, Rule::Trap].contains(&rule), "{kind}: {rule:?}");
    }
    let marked = hearing(Kind::RowIn, |payload| {
        if payload[10] > 1 {
            payload.truncate(11);
        }
    });
    assert_eq!(broken(&marked).0, Rule::Skipped);
}

#[test]
fn each_entry_of_a_packet_is_looked_at() {
    let report = said_by(&Options::default(), |packet| {
        let second =
            refusal(&packet).filter(|refusal| refusal.code == RefusalCode::Range && refusal.detail == 2);
        match second.filter(|refusal| refusal.kind == Kind::TableWrite.code()) {
            Some(refusal) => Some(carried_out(&packet, refusal)),
            None => Some(packet),
        }
    });
    assert_eq!(broken(&report).0, Rule::Entry);
}

/// Row factors (0), the kernel (1), and a grid (3), whose memory extends beyond the rows.
#[test]
fn entries_are_written_and_summed_up_where_they_are_asked_for() {
    let at_0 = |table: u8| {
        move |payload: &mut Vec<u8>| {
            if payload.len() > 6
                && span(payload).0 == table
                && span(payload).1 < NODES as u16
                && span(payload).2 == 1
            {
                payload[3..5].fill(0);
            }
        }
    };
    for (kind, table) in [(Kind::TableWrite, 1), (Kind::TableCrc, 0), (Kind::TableCrc, 1)] {
        let rule = broken(&hearing(kind, at_0(table))).0;
        assert!([Rule::Address, Rule::Span].contains(&rule), "{kind}, {table}: {rule:?}");
    }
    let options = Options { max_height: 512, ..Options::default() };
    let short = Altered::new(&options, |toward, mut packet: Passing| {
        if toward == Toward::Board
            && packet.is(Kind::TableWrite)
            && packet.payload.len() == 11
            && packet.payload[0] == 3
        {
            packet.payload[4] &= 3;
        }
        vec![packet]
    });
    let short = judge_by_plan(&plan(), short.candidate());
    assert_eq!(broken(&short).0, Rule::Address);
}

#[test]
fn tables_of_the_other_bank_are_written_while_a_row_is_inside() {
    let report = refusing(Kind::TableWrite, |payload| payload == [0; 7], RefusalCode::Busy);
    assert_eq!(broken(&report).0, Rule::Inside);
}

#[test]
fn signatures_are_expected_of_the_rows_that_they_are_for() {
    let report = hearing(Kind::Expect, |payload| {
        if payload[..2] == [1, 0] {
            payload[0] = 0;
        }
    });
    assert_eq!(broken(&report).0, Rule::Trap);
}

#[test]
fn a_board_that_counts_less_than_came_fails() {
    let reports = [
        (Counter::RowsRepeated, counting(|status| status.rows_repeated = 0)),
        (Counter::RowsUnneeded, counting(|status| status.rows_unneeded = status.rows_unneeded.min(2))),
        (Counter::Refusals, counting(|status| status.refusals = status.refusals.min(255))),
        (Counter::ForeignPackets, counting(|status| status.foreign_packets = 0)),
    ];
    for (counter, report) in reports {
        assert_eq!(miscounted(&report), counter);
    }
}

#[test]
fn a_row_that_comes_again_with_other_fields_fails() {
    let told = ["its first", "its last", "pauses of", "the CRC of", "1 wrong sample", "a count of 3 repeats"];
    for (field, told) in told.into_iter().enumerate() {
        let report = altering(move |toward, packet| match packet.reply() {
            Some(Reply::RowOut(row)) if toward == Toward::Host && row.repeats > 1 => {
                vec![packet.with_row(|row, packed| match field {
                    0 => row.first_latency ^= 1,
                    1 => row.last_latency ^= 1,
                    2 => row.pauses ^= 1,
                    3 => row.entered = row.entered.map(|crc| crc ^ 1),
                    4 => packed[0] ^= 1,
                    _ => row.repeats += 1,
                })]
            }
            _ => vec![packet],
        });
        assert_eq!(broken(&report).0, Rule::Again, "{field}: {}", report.headline());
        assert!(report.headline().contains(told), "{}", report.headline());
    }
}

#[test]
fn an_echo_of_nothing_is_nothing() {
    let report = answering(Kind::Echo, <[u8]>::is_empty, |packet| packet.payload.push(0));
    assert_eq!(broken(&report).0, Rule::Skipped);
}

#[test]
fn an_answer_that_ends_too_early_is_wrong() {
    // Of a request with a byte after its fields, which only the rules send.
    let report = answering(
        Kind::TableCrc,
        |payload| payload.len() == 7 + 1,
        |packet| {
            packet.payload.pop();
        },
    );
    assert_eq!(broken(&report).0, Rule::Skipped, "{}", report.headline());
}

/// The report on a board that denies the row in its trap where `is_lost` holds, for the row's number and for whether signatures
/// were uploaded since the last RESET.
fn trapping_less(is_lost: impl Fn(u16, bool) -> bool + Send + 'static) -> Report {
    let mut is_told = false;
    altering(move |_, packet| {
        is_told = packet.is(Kind::Expect) || is_told && !packet.is(Kind::Reset);
        match packet.reply() {
            Some(Reply::Trap(Some(kept))) if is_lost(kept.row, is_told) => {
                vec![packet.saying(&Reply::Trap(None))]
            }
            _ => vec![packet],
        }
    })
}

#[test]
fn what_is_expected_stays_after_a_reset_and_rows_far_down_are_trapped() {
    for report in [trapping_less(|_, is_told| !is_told), trapping_less(|row, _| row >= 20)] {
        assert_eq!(broken(&report).0, Rule::Trap);
    }
}
