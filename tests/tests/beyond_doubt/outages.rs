//! Links that break behind something wrong that may have come from the link: it is looked at again where the board comes back, and
//! told where it does not.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use halfrow::link::{Candidate, Link};
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Outcome, Report};
use halfrow::run::{RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::RowOut;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::System;

use crate::stale_packets::Breakable;

/// How a board is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// In each row, always.
    Always,
    /// In each row up to the outage.
    Once,
}

/// Alters a bit of a row that comes back.
fn spoilt(packet: &Passing) -> Passing {
    match packet.reply() {
        Some(Reply::RowOut(row)) => {
            let mut packed = row.packed.to_vec();
            packed[0] ^= 1;
            packet.saying(&Reply::RowOut(RowOut { packed: &packed, ..row }))
        }
        _ => packet.clone(),
    }
}

/// A link to a board that is switched on, whose rows are spoilt if it is `wrong`.
fn board(wrong: bool) -> Box<dyn Link> {
    let alter = move |_, packet: Passing| vec![if wrong { spoilt(&packet) } else { packet }];
    Altered::new(&Options::default(), alter).candidate().link
}

/// The report on such a board over a link that brings the first CONFIGURE twice and breaks at the greeting of the next session. The
/// board comes back if the run waits for it so long.
fn unplugged_in_front_of_the_second_look(wrong: Wrong, reconnect: Option<Duration>) -> Report {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut greetings, mut configured) = (Arc::clone(&is_cut), 0, false);
    let alter = move |toward, packet: Passing| {
        if toward == Toward::Host {
            return vec![spoilt(&packet)];
        }
        greetings += usize::from(packet.is(Kind::Hello));
        cut.store(greetings > 1, Ordering::Relaxed);
        let is_first = packet.is(Kind::Configure) && !std::mem::replace(&mut configured, true);
        let twice = is_first.then(|| packet.clone());
        twice.into_iter().chain([packet]).collect()
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let link: Box<dyn Link> = Box::new(Breakable { link: candidate.link, is_cut });
    let candidate = Candidate { link, ..candidate };
    let back = move || Ok::<_, std::io::Error>(board(wrong == Wrong::Always));
    let candidate = Candidate { reopen: Some(Box::new(move || back().map_err(Into::into))), ..candidate };
    let options = RunOptions { reconnect, ..RunOptions::default() };
    verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report
}

#[test]
fn a_board_that_comes_back_in_front_of_a_second_look_is_looked_at_again() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, Some(LIMIT));
    assert_eq!(report.verdict, Verdict::Fail, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
    let report = unplugged_in_front_of_the_second_look(Wrong::Once, Some(LIMIT));
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict, Verdict::Error, "{}", report.headline());
}

#[test]
fn what_was_found_is_told_although_the_link_broke_in_front_of_the_second_look() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, None);
    assert_eq!((report.verdict, report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(broken_off.found, Finding::SamplesDiffer { .. }), "{}", report.headline());
    assert_eq!(broken_off.reason.code(), "link-broke");
    assert!(report.headline().contains("samples differ"), "{}", report.headline());
    assert!(report.remedy().is_some_and(|remedy| remedy.contains("cable")), "{:?}", report.remedy());
    let failed = report.checks.iter().filter(|check| check.outcome == Outcome::Failed);
    assert_eq!(failed.map(|check| check.name).collect::<Vec<CheckName>>(), []);
}
