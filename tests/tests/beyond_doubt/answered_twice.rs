//! Boards that answer what they must not, or too often; and links that double packets, too.

use halfrow::result::{Answer, CheckName, Finding, Report, Rule};
use halfrow::verdict::Verdict;
use halfrow_protocol::Kind;
use halfrow_protocol::samples::{pack, unpack};
use halfrow_protocol::{Reply, message};
use halfrow_tests::altered::{Passing, Toward, judge};
use halfrow_tests::system::{System, failed_check};

use super::by_the_rules::{altering, broken};

/// The report on a board where each packet that is `doubled` comes twice, and each row becomes what `alter` makes of it.
fn doubling(
    doubled: impl Fn(Toward, &Passing) -> bool + Send + 'static,
    alter: impl Fn(Passing) -> Passing + Send + 'static,
) -> Report {
    altering(move |toward, packet| {
        let is_doubled = doubled(toward, &packet);
        let packet = if packet.is(Kind::RowOut) { alter(packet) } else { packet };
        let copy = is_doubled.then(|| packet.clone());
        [packet].into_iter().chain(copy).collect()
    })
}

fn is_reply(toward: Toward, packet: &Passing) -> bool {
    toward == Toward::Host && !packet.is(Kind::RowOut)
}

#[test]
fn a_board_that_answers_everything_twice_fails() {
    let report = doubling(is_reply, |packet| packet);
    assert_eq!((broken(&report).0, broken(&report).2), (Rule::Once, &Answer::Twice {}));
}

#[test]
fn a_link_that_doubles_packets_makes_no_sound_board_fail() {
    let links: [fn(Toward, &Passing) -> bool; 3] = [
        |_, _| true,
        |toward, _| toward == Toward::Host,
        |toward, packet| toward == Toward::Board && !packet.is(Kind::RowIn),
    ];
    for doubled in links {
        let report = doubling(doubled, |packet| packet);
        assert_ne!(report.verdict(), Verdict::Fail, "{}", report.headline());
    }
}

/// The row with a wrong last sample.
fn spoilt(packet: &Passing) -> Passing {
    packet.with_row(|row, packed| {
        let mut samples = vec![0; row.place.width.into()];
        unpack(packed, &mut samples);
        samples.last_mut().into_iter().for_each(|sample| *sample ^= 1);
        packed.clear();
        pack(&samples, packed);
    })
}

/// As many packets reached the board as were sent, so no request came twice.
#[test]
fn wrong_samples_of_a_board_that_answers_twice_are_its_own() {
    let report = judge(&System::TINY, |toward, packet| {
        let packet = spoilt(&packet);
        let copy = is_reply(toward, &packet).then(|| packet.clone());
        [packet].into_iter().chain(copy).collect()
    });
    assert_eq!(failed_check(&report), Some(CheckName::Frames), "{}", report.headline());
}

/// The board answers each damaged packet with a refusal under the number of that packet.
#[test]
fn a_board_that_answers_damaged_packets_fails() {
    let mut last = None;
    let report = altering(move |toward, packet| {
        if toward == Toward::Board {
            return vec![packet];
        }
        // The damaged packets follow the write to which they belong, under the next number.
        let is_written = packet.is(Kind::TableWrite);
        let is_read = packet.is(Kind::TableRead);
        let before = std::mem::replace(&mut last, is_written.then_some(packet.header.sequence));
        match before.filter(|number| is_read && packet.header.sequence == number.wrapping_add(2)) {
            None => vec![packet],
            Some(number) => {
                let refusal = message::Refusal {
                    code: message::RefusalCode::Payload,
                    kind: Kind::TableWrite.code(),
                    detail: 0,
                };
                let mut own = packet.saying(&Reply::Refusal(refusal));
                own.header.sequence = number.wrapping_add(1);
                vec![own, packet]
            }
        }
    });
    let Finding::RuleBroken { rule, right, .. } = &report.finding else { panic!("{}", report.headline()) };
    assert_eq!((*rule, right), (Rule::Damage, &Answer::Nothing {}));
}
