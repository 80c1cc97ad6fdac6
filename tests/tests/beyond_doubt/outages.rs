//! Links that break after something wrong that may be the link's fault: it is judged again when the board comes back, and
//! reported when it does not.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use halfrow::link::{Candidate, Link};
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Outcome, Report, SoakLength};
use halfrow::run::{AtSpeed, Plan, RunOptions, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{Records, RowOut};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::System;

use crate::stale_packets::cut_when_told;

/// When a board is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// In every row, always.
    Always,
    /// In every row until the outage.
    Once,
}

/// The packet with a wrong bit, if it is a row that comes back.
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

/// A link to a board that is just switched on; if `wrong`, its rows are spoilt.
fn board(wrong: bool) -> Box<dyn Link> {
    let alter = move |_, packet: Passing| vec![if wrong { spoilt(&packet) } else { packet }];
    Altered::new(&Options::default(), alter).candidate().link
}

/// A board with packets that `alter` rewrites, over a link that can be cut.
fn breakable(
    alter: impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static,
    is_cut: Arc<AtomicBool>,
) -> Candidate {
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let link = cut_when_told(candidate.link, is_cut);
    Candidate { link, ..candidate }
}

/// The report on such a board over a link that delivers the first CONFIGURE twice and breaks at the greeting of the next session.
/// If the run waits with `reconnect`, the board comes back.
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
    let candidate = breakable(alter, is_cut);
    let back = move || Ok::<_, std::io::Error>(board(wrong == Wrong::Always));
    let candidate = Candidate { reopen: Some(Box::new(move || back().map_err(Into::into))), ..candidate };
    let options = RunOptions { reconnect, ..RunOptions::default() };
    verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report
}

#[test]
fn a_board_that_comes_back_in_front_of_a_second_look_is_looked_at_again() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, Some(LIMIT));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
    let report = unplugged_in_front_of_the_second_look(Wrong::Once, Some(LIMIT));
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

#[test]
fn what_was_found_is_told_although_the_link_broke_in_front_of_the_second_look() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, None);
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(broken_off.found, Finding::SamplesDiffer { .. }), "{}", report.headline());
    assert_eq!(broken_off.reason.code(), "link-broke");
    assert!(report.headline().contains("samples differ"), "{}", report.headline());
    assert!(report.remedy().is_some_and(|remedy| remedy.contains("cable")), "{:?}", report.remedy());
    let failed = report.checks.iter().filter(|check| check.outcome == Outcome::Failed);
    assert_eq!(failed.map(|check| check.name).collect::<Vec<CheckName>>(), []);
}

/// The report on a board whose rows are spoilt, over a link that breaks once the fifth row of the first frame has left the board.
/// If the run waits with `reconnect`, the board comes back.
fn unplugged_in_the_middle_of_a_frame(wrong: Wrong, reconnect: Option<Duration>) -> Report {
    let is_cut = Arc::new(AtomicBool::new(false));
    let cut = Arc::clone(&is_cut);
    let alter = move |_, packet: Passing| {
        let is_fifth = matches!(packet.reply(), Some(Reply::RowOut(row)) if row.place.row == 4);
        cut.fetch_or(is_fifth, Ordering::Relaxed);
        vec![spoilt(&packet)]
    };
    let back = move || Ok(board(wrong == Wrong::Always));
    let candidate = Candidate { reopen: Some(Box::new(back)), ..breakable(alter, is_cut) };
    let options = RunOptions { reconnect, ..RunOptions::default() };
    verify(&System::TINY.plan(), candidate, &options, &Silent).unwrap().report
}

/// They are not judged when their frame is sent once more.
#[test]
fn rows_of_a_frame_that_the_link_broke_in_count_in_a_session_that_is_whole_alone() {
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Once, Some(LIMIT));
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Always, Some(LIMIT));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

#[test]
fn what_differed_in_a_frame_that_the_link_broke_in_is_in_the_report() {
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Always, None);
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let [frame] = &report.frames[..] else { panic!("{:?}", report.frames) };
    assert!((1..8).contains(&frame.rows) && frame.comparison.differences > 0, "{frame:?}");
}

/// BURST comes twice, a frame has another signature, and the link breaks at the greeting of the session in which the frame is
/// made again.
#[test]
fn a_soak_that_breaks_off_in_front_of_a_second_look_tells_what_differed() {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut greetings) = (Arc::clone(&is_cut), 0);
    let alter = move |toward, mut packet: Passing| {
        greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        cut.store(greetings > 1, Ordering::Relaxed);
        if toward == Toward::Host && packet.is(Kind::Records) {
            packet.payload.get_mut(Records::HEAD).into_iter().for_each(|byte| *byte ^= 1);
        }
        let twice = (toward == Toward::Board && packet.is(Kind::Burst)).then(|| packet.clone());
        twice.into_iter().chain([packet]).collect()
    };
    let at_speed = AtSpeed::Soak(SoakLength::Frames { frames: 3 });
    let plan = Plan { at_speed, fail_fast: false, ..System::TINY.plan() };
    let report = verify(&plan, breakable(alter, is_cut), &RunOptions::default(), &Silent).unwrap().report;
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(broken_off.found, Finding::DiffersAtSpeed { .. }), "{}", report.headline());
    assert_eq!(broken_off.reason.code(), "link-broke");
}
