//! Boards that are sound except for one rule, which only a request breaks that no host makes, or which only a header shows.

use std::ops::Range;

use halfrow::board::RefusalCode;
use halfrow::result::{Answer, Finding, Report, Rule};
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::Refusal;
use halfrow_protocol::{Header, Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward, judge_claims_by};
use halfrow_tests::system::judge_by_plan;

use super::by_the_rules::{
    altering, altering_each, answering, broken, carried_out, hearing, plan, refusal, refusing, said_by,
};

/// The kinds of which an empty packet is no answer to a request of the same kind; and the one that is refused only when the session
/// is closed, where no counter tells what a link did.
const LEFT_ALONE: [Kind; 4] = [Kind::Hello, Kind::RowOut, Kind::Refusal, Kind::Status];

/// The refusal in `packet`, unless it is of one of those kinds.
fn refusal_of_request(packet: &Passing) -> Option<Refusal> {
    refusal(packet).filter(|refusal| LEFT_ALONE.iter().all(|kind| kind.code() != refusal.kind))
}

/// How often a sound board refuses a request in the run.
fn refusals_of_a_sound_board() -> usize {
    let (sender, refused) = std::sync::mpsc::channel();
    let report = said_by(&Options::default(), move |packet| {
        refusal_of_request(&packet).into_iter().for_each(|it| sender.send(it).unwrap());
        Some(packet)
    });
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    refused.iter().count()
}

#[test]
fn each_refusal_that_does_not_come_fails() {
    let refusals = refusals_of_a_sound_board();
    assert!(refusals > 400, "{refusals}");
    let mut rules = Vec::new();
    for place in (0..refusals).step_by(17) {
        let mut count = 0;
        let report = said_by(&Options::default(), move |packet| {
            let Some(refusal) = refusal_of_request(&packet) else { return Some(packet) };
            count += 1;
            Some(if count == place + 1 { carried_out(&packet, refusal) } else { packet })
        });
        let (rule, right, found) = broken(&report);
        assert!(
            matches!(right, Answer::Refused { .. }) && matches!(found, Answer::Replied { .. }),
            "{rule:?}"
        );
        if !rules.contains(&rule) {
            rules.push(rule);
        }
    }
    assert!(rules.len() > 8, "{rules:?}");
}

/// Where COMMIT names its frame and its shape (WIRE.md, 13).
const FRAME: Range<usize> = 8..10;
const SHAPE: Range<usize> = 11..13;
const SPANS: [Kind; 3] = [Kind::TableWrite, Kind::TableRead, Kind::TableCrc];

/// The rule that a board breaks which takes the byte `at` in requests of `kind`, if it is `given`, for `taken`.
fn mistaking(options: &Options, kind: Kind, at: usize, [given, taken]: [u8; 2]) -> Rule {
    let altered = Altered::new(options, move |toward, mut packet: Passing| {
        if toward == Toward::Board
            && packet.is(kind)
            && let Some(byte) = packet.payload.get_mut(at).filter(|byte| **byte == given)
        {
            *byte = taken;
        }
        vec![packet]
    });
    broken(&judge_by_plan(&plan(), altered.candidate())).0
}

#[test]
fn a_level_or_table_or_bank_without_meaning_is_taken_for_no_other() {
    let (any, gridless) = (Options::default(), Options { datapath2: false, ..Options::default() });
    assert_eq!(mistaking(&any, Kind::Reset, 0, [3, 0]), Rule::Payload);
    for kind in SPANS {
        for (options, at, mistaken) in
            [(&any, 0, [2, 0]), (&any, 1, [2, 0]), (&any, 1, [3, 1]), (&gridless, 0, [3, 0])]
        {
            assert_eq!(mistaking(options, kind, at, mistaken), Rule::Payload, "{kind}, {at}: {mistaken:?}");
        }
    }
}

/// What the buffer still holds is taken for what is missing.
#[test]
fn entries_and_signatures_that_are_cut_short_are_not_written() {
    for (kind, count, fields) in [(Kind::TableWrite, 5, 7), (Kind::Expect, 2, 4)] {
        let report = hearing(kind, move |payload| {
            if let Some(&entries) = payload.get(count)
                && payload.len() > fields
                && payload[0] == 0
            {
                payload.resize(payload.len().max(fields + 4 * usize::from(entries)), 0);
            }
        });
        assert_eq!(broken(&report).0, Rule::Payload, "{kind}");
    }
}

#[test]
fn a_commit_with_a_v_of_0_is_of_row_factors() {
    let refusal = Refusal { code: RefusalCode::Range, kind: Kind::Commit.code(), detail: 2 };
    let refused = move |packet: &mut Passing| *packet = packet.saying(&Reply::Refusal(refusal));
    let report = answering(Kind::Commit, |payload| payload.get(SHAPE) == Some(&[0, u8::MAX]), refused);
    assert_eq!(broken(&report).0, Rule::NoGrid);
}

#[test]
fn no_bit_of_the_frame_of_a_commit_is_lost() {
    // Those for which the rules commit.
    let frames = [0x5a5a, !0x5a5a].map(u16::to_le_bytes);
    for bit in 0..u16::BITS {
        for stays in [0, 1 << bit] {
            let report = hearing(Kind::Commit, move |payload| {
                let Some(frame) = payload.get_mut(FRAME).filter(|frame| frames.iter().any(|it| it == frame))
                else {
                    return;
                };
                let named = u16::from_le_bytes([frame[0], frame[1]]);
                frame.copy_from_slice(&(named & !(1 << bit) | stays).to_le_bytes());
            });
            assert_eq!(report.verdict(), Verdict::Fail, "{bit}, {stays}: {}", report.headline());
        }
    }
}

/// Where ROW_IN names its frame (WIRE.md, 20).
const FRAME_OF_ROW: Range<usize> = 4..6;

/// For one of these frames the board has tables, it says.
#[test]
fn only_the_frame_of_a_commit_has_its_tables() {
    for frame in [0x5a5a ^ 1 << 5, !0x5a5a ^ 1 << 12].map(u16::to_le_bytes) {
        let mut is_of_it = false;
        let report = altering(move |toward, packet| {
            if toward == Toward::Board {
                is_of_it = packet.is(Kind::RowIn) && packet.payload.get(FRAME_OF_ROW) == Some(&frame[..]);
            }
            let refused = refusal(&packet).filter(|it| is_of_it && it.code == RefusalCode::NotReady);
            vec![refused.map_or(packet.clone(), |refused| {
                packet.saying(&Reply::Refusal(Refusal { code: RefusalCode::Row, ..refused }))
            })]
        });
        assert_eq!(broken(&report).0, Rule::NotReady, "{frame:?}");
    }
}

/// The tallest grid of the widest frames that the board can have, and the next one.
#[test]
fn a_board_has_the_grids_that_its_entries_have_room_for_and_no_others() {
    let table_crc = Refusal { code: RefusalCode::TableCrc, kind: Kind::Commit.code(), detail: 3 };
    let range = Refusal { code: RefusalCode::Range, detail: 2, ..table_crc };
    for (right, wrong) in [(table_crc, range), (range, table_crc)] {
        let mut is_wide = false;
        let report = altering(move |toward, packet| {
            if toward == Toward::Board && packet.is(Kind::Configure) {
                is_wide = packet.payload[..2] == Options::default().max_width.to_le_bytes();
            }
            let is_meant = is_wide && toward == Toward::Host && refusal(&packet) == Some(right);
            vec![if is_meant { packet.saying(&Reply::Refusal(wrong)) } else { packet }]
        });
        assert_eq!(broken(&report).0, Rule::Shape, "{wrong:?}");
    }
}

/// To the board the row of the last number of all is one that may come.
#[test]
fn the_last_number_of_all_is_no_rows() {
    let report = altering(|_, packet| {
        let refused = refusal(&packet).filter(|_| packet.header.window == u32::MAX);
        vec![refused.map_or(packet.clone(), |refused| {
            packet.saying(&Reply::Refusal(Refusal { code: RefusalCode::Row, ..refused }))
        })]
    });
    assert_eq!(broken(&report).0, Rule::Credit);
}

/// Each bit of the count, which is in byte 18 of a row.
#[test]
fn a_row_says_how_often_it_came_before() {
    for bit in 0..7 {
        let report = altering_each(move |toward, packet| {
            if toward == Toward::Host && packet.is(Kind::RowOut) {
                packet.payload[18] &= !(1 << bit);
            }
        });
        assert_eq!(report.verdict(), Verdict::Fail, "{bit}: {}", report.headline());
    }
}

#[test]
fn the_port_of_a_write_is_not_looked_at() {
    let report = refusing(Kind::TableWrite, |payload| payload.get(2) > Some(&1), RefusalCode::Range);
    assert_eq!(broken(&report).0, Rule::Address);
}

/// The board has bursts and denies it, or has a trap and denies that.
#[test]
fn what_a_board_does_not_have_it_refuses_by_its_kind() {
    let without_bursts = judge_claims_by(&plan(), |board| board.bursts = None);
    let without_trap = judge_claims_by(&plan(), |board| {
        board.bursts.iter_mut().for_each(|bursts| bursts.trap = false);
    });
    for report in [without_bursts, without_trap] {
        assert_eq!(broken(&report).0, Rule::Kind, "{}", report.headline());
    }
}

/// The report on a board that changes the headers of what `is_meant`.
fn heading(is_meant: fn(&Passing) -> bool, change: fn(&mut Header)) -> Report {
    said_by(&Options::default(), move |mut packet| {
        if is_meant(&packet) {
            change(&mut packet.header);
        }
        Some(packet)
    })
}

#[test]
fn the_reply_to_a_greeting_is_the_first_packet_of_its_session() {
    let changes: [fn(&mut Header); 4] = [
        |header| header.session = 0,
        |header| header.session = header.session.wrapping_sub(1),
        |header| header.window = 0,
        |header| header.window += 1,
    ];
    for (place, change) in changes.into_iter().enumerate() {
        let report = heading(|packet| packet.is(Kind::Hello), change);
        assert_eq!(broken(&report).0, Rule::NewSession, "{place}");
    }
}

#[test]
fn a_refusal_of_a_greeting_belongs_to_no_session() {
    for code in [RefusalCode::Held, RefusalCode::Version] {
        let report = said_by(&Options::default(), move |mut packet| {
            if refusal(&packet).is_some_and(|refusal| refusal.code == code) {
                packet.header.session = 7;
            }
            Some(packet)
        });
        assert_eq!(broken(&report).0, Rule::RefusalSession, "{code}: {}", report.headline());
    }
}

#[test]
fn a_refused_row_leaves_the_window_where_it_is() {
    let changes: [fn(&mut Header); 2] = [|header| header.window = 0, |header| header.window -= 1];
    for change in changes {
        let of_row = |packet: &Passing| refusal(packet).is_some_and(|it| it.kind == Kind::RowIn.code());
        assert_eq!(broken(&heading(of_row, change)).0, Rule::Window);
    }
}

/// What is made of an acknowledgement, and how that is told.
type Answered = (fn(&Passing) -> Passing, Answer, &'static str);

/// In its own session, by replies and by a refusal without the flag that nobody looks at. What a reply holds is told in hexadecimal.
#[test]
fn an_acknowledgement_is_not_answered() {
    let replied = |payload: &str| Answer::Replied { payload: payload.to_owned() };
    let answers_of: [Answered; 3] = [
        (
            |ack| Passing { header: Header { reply: true, ..ack.header }, payload: Vec::new() },
            replied(""),
            "but it answered it with an empty reply (rule",
        ),
        (
            |ack| Passing { header: Header { reply: true, ..ack.header }, payload: vec![0x5a, 0x0f] },
            replied("5a0f"),
            "but it answered with 5a0f (rule",
        ),
        (
            |ack| {
                let (code, kind) = (RefusalCode::Kind, Kind::RowAck.code());
                ack.saying(&Reply::Refusal(Refusal { code, kind, detail: 0 }))
            },
            Answer::Refused { code: RefusalCode::Kind as u8, detail: 0 },
            "but it refused it as `kind` (rule",
        ),
    ];
    for (answer, answered, told) in answers_of {
        let mut answers = Vec::new();
        let report = altering(move |toward, packet| {
            if toward == Toward::Board && packet.is(Kind::RowAck) {
                answers.push(answer(&packet));
            }
            if toward == Toward::Board { vec![packet] } else { answers.drain(..).chain([packet]).collect() }
        });
        let Finding::RuleBroken { rule: Rule::Unanswered, found, .. } = &report.finding else {
            panic!("{}", report.headline())
        };
        assert_eq!((report.verdict(), found), (Verdict::Fail, &answered), "{}", report.headline());
        assert!(report.headline().contains(told), "{}", report.headline());
    }
}
