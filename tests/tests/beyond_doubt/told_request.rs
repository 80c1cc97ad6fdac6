//! What a finding tells of the request that was answered against a rule.

use std::sync::mpsc::channel;

use halfrow::board::RefusalCode;
use halfrow::result::{Asked, Field, Finding, Report, Rule};
use halfrow_protocol::message::Refusal;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward};

use super::by_the_rules::{altering, refusal};

fn asked(report: &Report) -> (Rule, &Asked) {
    match &report.finding {
        Finding::RuleBroken { rule, asked: Some(asked), .. } => (*rule, asked),
        other => panic!("{}", other.sentence()),
    }
}

fn named(asked: &Asked) -> Vec<(&str, u32)> {
    asked.fields.iter().map(|Field { name, value }| (&**name, *value)).collect()
}

fn number(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |number, byte| number * 256 + u32::from(*byte))
}

/// WIRE.md, 18: width, height, centre2 and blanking of two bytes each, then four of gap_seed and one of bits.
#[test]
fn the_request_that_was_answered_wrongly_is_told_as_it_was_sent() {
    let (sender, answered) = channel();
    let mut sent = None;
    let report = altering(move |toward, packet| {
        if toward == Toward::Board {
            sent = packet.is(Kind::Configure).then(|| packet.clone());
            return vec![packet];
        }
        let out_of_range = |it: &Refusal| (it.kind, it.code) == (Kind::Configure.code(), RefusalCode::Range);
        let Some(it) = refusal(&packet).filter(out_of_range) else { return vec![packet] };
        sent.take().map(|sent: Passing| sender.send(sent));
        vec![packet.saying(&Reply::Refusal(Refusal { detail: it.detail + 9, ..it }))]
    });
    let (rule, asked) = asked(&report);
    assert_eq!(rule, Rule::Configuration, "{}", report.headline());
    let sent = answered.try_iter().next().unwrap();
    let [width, height] = [&sent.payload[..2], &sent.payload[2..4]].map(number);
    let fields = [
        ("width", width),
        ("height", height),
        ("centre2", number(&sent.payload[4..6])),
        ("blanking", number(&sent.payload[6..8])),
        ("gap_seed", number(&sent.payload[8..12])),
        ("bits", number(&sent.payload[12..13])),
    ];
    assert_eq!(named(asked), fields);
    assert_eq!((asked.sequence, asked.bytes, &*asked.rest), (sent.header.sequence, 13, ""));
    let told = format!(
        "), where CONFIGURE had sequence {} and 13 bytes: width {width}, height {height}, ",
        asked.sequence
    );
    assert!(report.headline().contains(&told), "{}", report.headline());
}

/// Rows whose answer depends on a commit are refused although one is pending, with tables that were forgotten before.
#[test]
fn the_frame_that_a_commit_waits_for_is_told_with_the_row_of_another_frame() {
    let (mut has_forgotten, mut is_pending) = (false, false);
    let report = altering(move |toward, packet| {
        if toward == Toward::Board {
            has_forgotten |= packet.is(Kind::Reset) && packet.payload[0] == 2;
            return vec![packet];
        }
        is_pending |= has_forgotten && packet.is(Kind::Commit);
        let not_ready = |it: &Refusal| (it.kind, it.code) == (Kind::RowIn.code(), RefusalCode::NotReady);
        match refusal(&packet).filter(not_ready).filter(|_| is_pending) {
            Some(it) => vec![packet.saying(&Reply::Refusal(Refusal { code: RefusalCode::Row, ..it }))],
            None => vec![packet],
        }
    });
    let (rule, asked) = asked(&report);
    assert_eq!((rule, asked.pending), (Rule::NotReady, Some(0x5a5a)), "{}", report.headline());
    let frame = named(asked).into_iter().find(|(name, _)| *name == "frame").unwrap().1;
    assert_eq!((frame ^ 0x5a5a).count_ones(), 1, "{frame:04x}");
    let told = format!(", frame {frame}, row 0, width 64, flags 0, generation 0, then {}…", "00".repeat(16));
    assert!(report.headline().contains(&told), "{}", report.headline());
    assert!(
        report.headline().contains(", and a commit was pending for frame 23130"),
        "{}",
        report.headline()
    );
}
