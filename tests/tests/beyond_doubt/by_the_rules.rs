//! The smallest run with the rules, on boards whose packets are altered; and what it found.

use halfrow::result::{Answer, CheckName, Counter, Finding, Report, Rule};
use halfrow::run::{Part, Plan, Selection};
use halfrow_mock::Options;
use halfrow_protocol::message::{Refusal, RefusalCode, Status};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::system::{System, failed_check, judge_by_plan};

/// The smallest run with the rules.
pub(super) fn plan() -> Plan {
    Plan { selection: Some(Selection::least().with(Part::Rules, 1)), ..System::TINY.plan() }
}

/// The report on a board with packets that `alter` rewrites, each into those that it returns.
pub(super) fn altering(alter: impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static) -> Report {
    judge_by_plan(&plan(), Altered::new(&Options::default(), alter).candidate())
}

/// The report on a board with packets that `alter` changes.
pub(super) fn altering_each(mut alter: impl FnMut(Toward, &mut Passing) + Send + 'static) -> Report {
    altering(move |toward, mut packet| {
        alter(toward, &mut packet);
        vec![packet]
    })
}

/// The report on a board that receives packets of `kind` as `alter` changes them.
pub(super) fn hearing(kind: Kind, alter: impl Fn(&mut Vec<u8>) + Send + 'static) -> Report {
    altering_each(move |toward, packet| {
        if toward == Toward::Board && packet.is(kind) {
            alter(&mut packet.payload);
        }
    })
}

/// The report on a board whose answer to a request of `kind`, if its payload `is_meant`, `alter` changes.
pub(super) fn answering(
    kind: Kind,
    is_meant: impl Fn(&[u8]) -> bool + Send + 'static,
    alter: impl Fn(&mut Passing) + Send + 'static,
) -> Report {
    let mut meant = None;
    altering_each(move |toward, packet| {
        if toward == Toward::Board {
            meant = (packet.is(kind) && is_meant(&packet.payload)).then_some(packet.header.sequence);
        } else if meant == Some(packet.header.sequence) && !packet.is(Kind::RowOut) {
            alter(packet);
        }
    })
}

/// The same with an answer that is a refusal.
pub(super) fn refusing(
    kind: Kind,
    is_meant: impl Fn(&[u8]) -> bool + Send + 'static,
    code: RefusalCode,
) -> Report {
    answering(kind, is_meant, move |packet| {
        *packet = packet.saying(&Reply::Refusal(Refusal { code, kind: kind.code(), detail: 0 }));
    })
}

/// The report on a board whose counters `alter` changes.
pub(super) fn counting(alter: impl Fn(&mut Status) + Send + 'static) -> Report {
    altering(move |toward, packet| match packet.reply() {
        Some(Reply::Status(mut status)) if toward == Toward::Host => {
            alter(&mut status);
            vec![packet.saying(&Reply::Status(status))]
        }
        _ => vec![packet],
    })
}

/// The report on a board of the build `options` after `alter` changed everything that it sends; none drops a packet.
pub(super) fn said_by(
    options: &Options,
    mut alter: impl FnMut(Passing) -> Option<Passing> + Send + 'static,
) -> Report {
    let altered = move |toward, packet| match toward {
        Toward::Board => vec![packet],
        Toward::Host => alter(packet).into_iter().collect(),
    };
    judge_by_plan(&plan(), Altered::new(options, altered).candidate())
}

pub(super) fn refusal(packet: &Passing) -> Option<Refusal> {
    match packet.reply() {
        Some(Reply::Refusal(refusal)) => Some(refusal),
        _ => None,
    }
}

/// The empty reply that says that the request was carried out, instead of this refusal.
pub(super) fn carried_out(packet: &Passing, refusal: Refusal) -> Passing {
    let mut header = packet.header;
    header.kind = refusal.kind;
    Passing { header, payload: Vec::new() }
}

pub(super) fn broken(report: &Report) -> (Rule, &Answer, &Answer) {
    assert_eq!(failed_check(report), Some(CheckName::Rules), "{}", report.headline());
    assert!(report.remedy().is_some());
    match &report.finding {
        Finding::RuleBroken { rule, right, found, .. } => (*rule, right, found),
        other => panic!("{}", other.sentence()),
    }
}

/// The counter that made the rules fail.
pub(super) fn miscounted(report: &Report) -> Counter {
    assert_eq!(failed_check(report), Some(CheckName::Rules), "{}", report.headline());
    match &report.finding {
        Finding::CounterWrong { counter, .. } => *counter,
        other => panic!("{}", other.sentence()),
    }
}
